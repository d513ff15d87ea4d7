#include "pipeline/pass_picture.h"

#include <algorithm>
#include <cmath>

namespace lumirank::pipeline {
namespace {

// Film samples of emission without a denoiser: in all passes together, and in each pass of an unknown number.
constexpr int kEmissionOfAll = 12, kEmissionOfPass = 2;

void add_image(const image::Image& from, image::Image& to) {
  for (std::size_t p = 0; p < from.pixels.size(); ++p) to.pixels[p] += from.pixels[p];
}

}  // namespace

bool PassPicture::add(int number, int wanted, const image::Image& sent, const FilmInput& film, double left,
                      const Sinks& sinks) {
  mean_.add(sent);
  if (denoising_.wanted())
    return number == 0 ? denoising_.trace_first(film.world, film.view, film.recipe, left, sinks)
                       : denoising_.trace_another(number, sinks);
  if (parts_.emission) emission_.add(emission_of_pass(wanted, film));
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

// Without outliers of what is usual in `sent`; empty where nothing was traced.
image::Image PassPicture::mirrored(const image::Image& sent) const {
  if (!denoising_.traced() || !parts_.emission) return {};
  double sum = 0;
  for (const Rgb& p : sent.pixels) sum += static_cast<double>(luminance(p));
  const double usual = sum / static_cast<double>(sent.pixels.size());
  return without_fireflies(denoising_.features().mirrored, static_cast<float>(usual));
}

image::Image PassPicture::with_mirrored(image::Image sent) const {
  const image::Image shown = mirrored(sent);
  if (!shown.pixels.empty()) add_image(shown, sent);
  return sent;
}

image::Image PassPicture::with_mirrored_as_noise(image::Image difference) const {
  if (!denoising_.traced() || !parts_.emission) return difference;
  const image::Image shown = denoising_.features().mirrored;
  for (std::size_t p = 0; p < shown.pixels.size(); ++p)
    for (int c = 0; c < 3; ++c)
      difference.pixels[p][c] = std::abs(difference.pixels[p][c]) + 2 * shown.pixels[p][c];
  return difference;
}

image::Image PassPicture::with_emission(image::Image sent) const {
  if (parts_.emission)
    add_image(denoising_.traced() ? denoising_.features().emission : emission_.mean(), sent);
  return sent;
}

}  // namespace lumirank::pipeline
