#include "pipeline/pass_picture.h"

#include <algorithm>

#include "base/error.h"
#include "base/timer.h"

namespace lumirank::pipeline {
namespace {

// The film whose denoising tells what the picture's will take; and what a larger one may take more.
constexpr int kDenoiserTrial = 192;
constexpr double kDenoiserMargin = 1.15;
// Features that are called clean are worth more, and take this many times longer: where that is at most such
// a part of the budget.
constexpr double kCleanOverNoisy = 2.6, kTimeOfClean = 0.1;
// Of fewer pixels a side it knows too little.
constexpr int kSmallestDenoised = 16;
// Film samples at edges, beside those of all pixels; under a budget as many as this part of what is left
// pays, but no fewer than leave fur dotted.
constexpr int kEdgeSamples = 12, kMinEdgeSamples = 5;
constexpr double kTimeOfEdges = 0.08;
// Beside these where emission glares.
constexpr int kGlaringSamples = 48;
// Without a denoiser, in each pass of an unknown number.
constexpr int kEmissionSamples = 2;

void add_image(const image::Image& from, image::Image& to) {
  for (std::size_t p = 0; p < from.pixels.size(); ++p) to.pixels[p] += from.pixels[p];
}

}  // namespace

PassPicture::PassPicture(const RenderSettings& settings, const View& view, methods::TimedChoices& choices,
                         const Sinks& sinks)
    : settings_(settings), parts_(wanted_parts(settings.view.only)) {
  if (settings.denoise == Denoise::off) return;
  const denoise::Found& found = denoise::Denoiser::find();
  denoiser_ = found.denoiser;
  if (denoiser_) {
    if (timed()) try_denoiser(view, choices);
  } else if (settings.denoise == Denoise::on) {
    throw InputError(found.trouble, "leave out --denoise");
  } else {
    trouble_ = found.trouble;
    sinks.say("the picture keeps its noise, which a denoiser would take out: " + trouble_);
  }
}

void PassPicture::try_denoiser(const View& view, methods::TimedChoices& choices) {
  const image::Image trial(kDenoiserTrial, kDenoiserTrial, Rgb(0.5f));
  denoiser_->denoise(trial, &trial, &trial);  // the first time everything takes longer
  const Timer timer;
  denoiser_->denoise(trial, &trial, &trial);
  denoiser_seconds_ = kDenoiserMargin * timer.seconds() * static_cast<double>(view.width) *
                      static_cast<double>(view.height) / (kDenoiserTrial * kDenoiserTrial);
  bool clean = kCleanOverNoisy * denoiser_seconds_ <= kTimeOfClean * settings_.time;
  if (const auto earlier = choices.earlier("clean_features", 1)) clean = *earlier == 1;
  choices.record("clean_features", clean ? 1 : 0);
  if (clean)
    denoiser_seconds_ *= kCleanOverNoisy;
  else
    features_are_ = denoise::Features::noisy;
}

double PassPicture::feature_seconds(double one_sample, double left) const {
  if (!denoiser_) return 0;
  return PixelFeatureTracing::kEverywhere * one_sample + kTimeOfEdges * std::max(0.0, left);
}

View PassPicture::filtered(View view) const {
  if (denoiser_) view.sensor.film.filter = scenedesc::FilterDesc{.kind = scenedesc::FilterKind::box};
  return view;
}

bool PassPicture::add(int number, int wanted, const image::Image& sent, const FilmInput& film, double left,
                      methods::TimedChoices& choices, const Sinks& sinks) {
  mean_.add(sent);
  if (denoiser_) return trace_features(number, film, left, choices, sinks);
  if (parts_.emission) emission_.add(emission_of_pass(wanted, film));
  return true;
}

// Most samples follow the first pass, when it is known what a pass takes; but what mirrors show of lamps
// takes as many as there are passes.
bool PassPicture::trace_features(int number, const FilmInput& film, double left,
                                 methods::TimedChoices& choices, const Sinks& sinks) {
  if (number == 0) {
    const Timer timer;
    features_.emplace(film.world, film.view, film.recipe);
    if (!features_->trace_all(sinks)) return false;
    const double one = timer.seconds() / PixelFeatureTracing::kEverywhere;  // in each pixel
    if (!features_->trace_differing(edge_samples(one, left, choices), sinks)) return false;
    const int glaring =
        samples_for("glaring_samples", one * features_->glaring(), left, {0, kGlaringSamples}, choices);
    return settings_.view.film_samples || features_->trace_glaring(glaring, sinks);
  }
  return number < kEdgeSamples || features_->trace_another(static_cast<std::uint64_t>(number), sinks);
}

int PassPicture::edge_samples(double one_everywhere, double left, methods::TimedChoices& choices) const {
  if (settings_.view.film_samples)
    return std::max(0, *settings_.view.film_samples - PixelFeatureTracing::kEverywhere);
  return samples_for("edge_samples", one_everywhere * features_->differing(), left,
                     {kMinEdgeSamples, kEdgeSamples}, choices);
}

// As many as may be had, or under a budget as a part of what is left pays, where one takes so long.
int PassPicture::samples_for(const char* choice, double one, double left, SampleRange range,
                             methods::TimedChoices& choices) const {
  if (!timed()) return range.max;
  int samples = range.max;
  if (one > 0)
    samples = static_cast<int>(std::clamp(kTimeOfEdges * left / one, 1.0 * range.min, 1.0 * range.max));
  if (const auto earlier = choices.earlier(choice, range.max)) samples = static_cast<int>(*earlier);
  choices.record(choice, samples);
  return samples;
}

// Filtered as all else is.
image::Image PassPicture::emission_of_pass(int wanted, const FilmInput& film) const {
  Recipe recipe = film.recipe;
  const int usual = timed() ? kEmissionSamples : std::clamp(kEdgeSamples / wanted, 1, kEdgeSamples);
  recipe.film_samples = std::max(1, settings_.view.film_samples.value_or(usual));
  const FilmParts emission{.matrix = false, .traced_direct = false, .traced_indirect = false};
  return develop({film.world, film.view, recipe, film.rows, film.traced}, {}, emission);
}

image::Image PassPicture::sent(const RestTracing& rest) const {
  image::Image image = mean_.mean();
  rest.add_to(image);
  if (!features_ || !parts_.emission) return image;
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += static_cast<double>(luminance(p));
  const double usual = sum / static_cast<double>(image.pixels.size());
  add_image(without_fireflies(features_->means().mirrored, static_cast<float>(usual)), image);
  return image;
}

image::Image PassPicture::with_emission(image::Image sent) const {
  if (parts_.emission) add_image(features_ ? features_->means().emission : emission_.mean(), sent);
  return sent;
}

std::optional<image::Image> PassPicture::denoised(const image::Image& sent) const {
  if (!features_ || std::min(sent.width, sent.height) < kSmallestDenoised ||
      std::all_of(sent.pixels.begin(), sent.pixels.end(), [](Rgb c) { return is_black(c); }))
    return {};
  const PixelFeatures features = features_->means();
  return denoiser_->denoise(sent, &features.albedo, &features.normal, features_are_);
}

}  // namespace lumirank::pipeline
