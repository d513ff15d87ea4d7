#include "pipeline/pass_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "denoise/enlarging.h"

namespace lumirank::pipeline {
namespace {

// Film samples of emission without a denoiser: in all passes together, and in each pass of an unknown number.
constexpr int kEmissionOfAll = 12, kEmissionOfPass = 2;

}  // namespace

bool PassPicture::begin(const world::World& world, const Recipe& recipe, double left, const Sinks& sinks) {
  return !denoising_.wanted() || denoising_.trace_first(world, whole_, recipe, left, sinks);
}

bool PassPicture::add(const Pass& pass, const image::Image& sent, const FilmInput& film, const Sinks& sinks) {
  mean_.add(sent, pass.weight, pass.pixels);
  if (!pass.begins) return true;
  if (denoising_.wanted()) return pass.number == 0 || denoising_.trace_another(pass.number, sinks);
  if (parts_.emission) emission_.add(emission_of_pass(pass.wanted, film));
  return true;
}

// Filtered as all else is.
image::Image PassPicture::emission_of_pass(int wanted, const FilmInput& film) const {
  Recipe recipe = film.recipe;
  const int usual =
      settings_.time > 0 ? kEmissionOfPass : std::clamp(kEmissionOfAll / wanted, 1, kEmissionOfAll);
  recipe.film_samples = std::max(1, settings_.view.film_samples.value_or(usual));
  const FilmParts emission{.matrix = false, .traced_direct = false, .traced_indirect = false};
  return develop({film.world, film.view, recipe, film.rows, film.traced}, {}, emission);
}

image::Image PassPicture::sent(const RestTracing& rest) const {
  image::Image image = mean_.mean();
  rest.add_to(image);
  return image;
}

NoisyPicture PassPicture::with_noise(const RestTracing& rest) const {
  NoisyPicture passes{sent(rest), mean_.difference()};
  rest.add_difference_to(passes.difference);
  return passes;
}

// Empty where nothing was traced.
image::Image PassPicture::noisy_emission(const image::Image& sent) const {
  if (!denoising_.traced() || !parts_.emission) return {};
  return denoising_.noisy_emission(sent);
}

image::Image PassPicture::with_noisy_emission(image::Image sent) const {
  const image::Image shown = noisy_emission(sent);
  if (!shown.pixels.empty()) image::add_to(sent, shown);
  return sent;
}

image::Image PassPicture::with_emission_as_noise(image::Image difference) const {
  if (!denoising_.traced() || !parts_.emission) return difference;
  return denoising_.with_emission_as_noise(std::move(difference));
}

image::Image PassPicture::with_emission(image::Image sent) const {
  if (parts_.emission)
    image::add_to(sent, denoising_.traced()
                            ? denoise::reduced(denoising_.features().emission, sent.width, sent.height)
                            : emission_.mean());
  return sent;
}

image::Image PassPicture::enlarged_with_emission(image::Image sent) const {
  image::Image large = denoising_.enlarged(std::move(sent));
  if (parts_.emission) image::add_to(large, denoising_.features().emission);
  return large;
}

}  // namespace lumirank::pipeline
