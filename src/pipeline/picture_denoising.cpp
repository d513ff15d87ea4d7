#include "pipeline/picture_denoising.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/timer.h"
#include "denoise/enlarging.h"
#include "denoise/fireflies.h"
#include "denoise/outliers.h"
#include "denoise/overshoot.h"
#include "denoise/unpremultiply.h"

namespace lumirank::pipeline {
namespace {

// The film whose denoising tells what the picture's will take, up to a third too much if it is small: where
// that does not matter; and what a larger one may take more.
constexpr int kDenoiserTrial = 256, kShortDenoiserTrial = 128, kDenoiserWarmUp = 64;
constexpr double kShortBudget = 5, kDenoiserMargin = 1.1;
// What enlarging to a film takes, and what follows for any, over denoising it with noisy features.
constexpr double kEnlargingOverDenoising = 0.25, kAfterOverDenoising = 0.3;
// Clean features take this many times longer, and are used where that is at most such a part of the budget.
constexpr double kCleanOverNoisy = 2.4, kTimeOfClean = 0.12;
// Orientations, and with how many of them denoising may take what part of the budget: the second is worth
// more than two others.
constexpr int kOrientations = 2, kMostOrientations = 4;
constexpr double kTimeOfOrientations = 0.1, kTimeOfMostOrientations = 0.06;
// Of fewer pixels a side it knows too little.
constexpr int kSmallestDenoised = 16;
// Film samples of each pixel; and of a larger film's than is rendered.
constexpr int kEverywhere = 4, kEverywhereOfLarger = 2;
// Film samples at edges, beside those of all pixels; under a budget as many as this part of what is left
// pays, but no fewer than leave fur dotted, unless these took a fifth.
constexpr int kEdgeSamples = 12, kMinEdgeSamples = 5;
constexpr double kTimeOfEdges = 0.08, kMostOfEdges = 0.2;
// Beside these where emission glares.
constexpr int kGlaringSamples = 48;

}  // namespace

image::Image without_fireflies(const pathtrace::PathFilm& film, bool with_emission) {
  image::Image sent = denoise::without_fireflies(film.sent(), film.sent_deviation());
  if (with_emission) image::add_to(sent, film.result().emission);
  return sent;
}

PictureDenoising::PictureDenoising(const RenderSettings& settings, const View& view,
                                   methods::TimedChoices& choices, const Sinks& sinks, double pixel_seconds)
    : settings_(settings),
      choices_(choices),
      asked_filter_(world::make_filter(view.sensor.film.filter)),
      pixel_seconds_(pixel_seconds) {
  if (settings.denoise == Denoise::off) return;
  const denoise::Found& found = denoise::Denoiser::find();
  denoiser_ = found.denoiser;
  if (denoiser_) {
    if (timed()) try_denoiser(view);
  } else if (settings.denoise == Denoise::on) {
    throw InputError(found.trouble, "leave out --denoise");
  } else {
    trouble_ = found.trouble;
    sinks.say("the picture keeps its noise, which a denoiser would take out: " + trouble_);
  }
}

void PictureDenoising::note(bool was_used, std::map<std::string, std::string>& notes) const {
  notes["denoiser"] = was_used ? "Open Image Denoise " + denoiser_->version() : "none";
  if (!trouble_.empty()) notes["denoiser.trouble"] = trouble_;
}

void PictureDenoising::try_denoiser(const View& view) {
  if (pixel_seconds_ == 0) {
    const auto seconds = [&](int size) {
      const image::Image trial(size, size, Rgb(0.5f));
      const Timer timer;
      denoiser_->denoise(trial, &trial, &trial);
      return timer.seconds();
    };
    seconds(kDenoiserWarmUp);  // the first time everything takes longer
    const int trial = settings_.time < kShortBudget ? kShortDenoiserTrial : kDenoiserTrial;
    pixel_seconds_ = kDenoiserMargin * seconds(trial) / (trial * trial);
  }
  seconds_of_whole_ = pixel_seconds_ * static_cast<double>(view.width) * static_cast<double>(view.height);
}

double PictureDenoising::Quality::times() const { return (clean ? kCleanOverNoisy : 1) * orientations; }

PictureDenoising::Quality PictureDenoising::expected_quality() const {
  if (!timed()) return {};
  const auto fits = [&](const Quality& quality, double part) {
    return quality.times() * seconds_once() <= part * settings_.time;
  };
  if (fits({true, kMostOrientations}, kTimeOfMostOrientations)) return {true, kMostOrientations};
  if (fits({true, kOrientations}, kTimeOfOrientations)) return {true, kOrientations};
  return {fits({true, 1}, kTimeOfClean), 1};
}

PictureDenoising::Quality PictureDenoising::chosen_quality(double unspent) const {
  Quality quality = expected_quality();
  if (!timed()) return quality;
  const double seconds =
      quality.times() * seconds_once() + std::max(0.0, unspent - kAfterOverDenoising * seconds_of_whole_);
  if (Quality{true, 1}.times() * seconds_once() < seconds) quality.clean = true;
  while (quality.orientations < kMostOrientations &&
         Quality{quality.clean, quality.orientations + 1}.times() * seconds_once() < seconds)
    ++quality.orientations;
  if (const auto earlier = choices_.earlier("clean_features", 1)) quality.clean = *earlier == 1;
  choices_.record("clean_features", quality.clean ? 1 : 0);
  if (const auto earlier = choices_.earlier("orientations", kMostOrientations))
    quality.orientations = std::max(1, static_cast<int>(*earlier));
  choices_.record("orientations", quality.orientations);
  return quality;
}

double PictureDenoising::seconds() const {
  return expected_quality().times() * seconds_once() +
         (divisor_ > 1 ? kEnlargingOverDenoising * seconds_of_whole_ : 0);
}

int PictureDenoising::samples_everywhere() const { return divisor_ == 1 ? kEverywhere : kEverywhereOfLarger; }

double PictureDenoising::seconds_of_feature(const world::World& world, const View& view, const Recipe& recipe,
                                            const Sinks& sinks) const {
  if (!denoiser_) return 0;
  const Timer timer;
  PixelFeatureTracing(world, view, recipe).trace_all(1, sinks);
  return timer.seconds();
}

double PictureDenoising::feature_seconds(double one_sample, double left) const {
  if (!denoiser_) return 0;
  return samples_everywhere() * one_sample + kTimeOfEdges * std::max(0.0, left);
}

View PictureDenoising::filtered(View view) const {
  if (denoiser_) view.sensor.film.filter = scenedesc::FilterDesc{.kind = scenedesc::FilterKind::box};
  return view;
}

std::optional<film::Filter> PictureDenoising::lacking_filter() const {
  if (!denoiser_) return {};
  return asked_filter_;
}

bool PictureDenoising::trace_first(const world::World& world, const View& view, const Recipe& recipe,
                                   double left, const Sinks& sinks) {
  features_.emplace(world, view, recipe);
  if (!features_->trace_all(samples_everywhere(), sinks)) return false;
  // What a sample takes at edges is measured there: glass has many, and eye rays branch in it.
  const Timer timer;
  const int first = settings_.view.film_samples.value_or(kEdgeSamples) > samples_everywhere() ? 1 : 0;
  if (!features_->trace_differing(first, sinks)) return false;
  const double at_edges = timer.seconds();
  if (!features_->trace_differing(edge_samples(at_edges, left) - first, sinks)) return false;
  const double differing = features_->differing();
  const double glaring_pixels = differing > 0 ? features_->glaring() / differing : 0;
  const int glaring = samples_for("glaring_samples", at_edges * glaring_pixels, left, {0, kGlaringSamples});
  return settings_.view.film_samples || features_->trace_glaring(glaring, sinks);
}

bool PictureDenoising::trace_another(int number, const Sinks& sinks) {
  return number < kEdgeSamples || features_->trace_all(1, sinks);
}

int PictureDenoising::edge_samples(double one, double left) const {
  if (settings_.view.film_samples) return std::max(0, *settings_.view.film_samples - samples_everywhere());
  const bool dear = one > 0 && kMinEdgeSamples * one > kMostOfEdges * left;
  const int min = dear ? std::max(1, static_cast<int>(kMostOfEdges * left / one)) : kMinEdgeSamples;
  return samples_for("edge_samples", one, left, {min, kEdgeSamples});
}

// As many as may be had, or under a budget as a part of what is left pays, where one takes so long.
int PictureDenoising::samples_for(const char* choice, double one, double left, SampleRange range) const {
  if (!timed()) return range.max;
  int samples = range.max;
  if (one > 0)
    samples = static_cast<int>(std::clamp(kTimeOfEdges * left / one, 1.0 * range.min, 1.0 * range.max));
  if (const auto earlier = choices_.earlier(choice, range.max)) samples = static_cast<int>(*earlier);
  choices_.record(choice, samples);
  return samples;
}

std::optional<denoise::Shrunk> PictureDenoising::denoised(const image::Image& picture,
                                                          const SampledNoise& noise, double unspent) const {
  if (!features_ || std::min(picture.width, picture.height) < kSmallestDenoised ||
      std::all_of(picture.pixels.begin(), picture.pixels.end(), [](Rgb c) { return is_black(c); }))
    return {};
  const PixelFeatures features = this->features();
  const auto of_its_size = [&](const image::Image& image) {
    return denoise::reduced(image, picture.width, picture.height);
  };
  image::Image light = picture, albedo = of_its_size(features.albedo), normal = of_its_size(features.normal);
  const image::Image cover = of_its_size(features.cover);
  if (noise.without_emission)
    for (image::Image* image : {&light, &albedo, &normal}) *image = denoise::unpremultiplied(*image, cover);
  const Quality quality = chosen_quality(unspent);
  const auto features_are = quality.clean ? denoise::Features::clean : denoise::Features::noisy;
  image::Image clean = denoise::without_overshoot(
      light, denoiser_->denoise(light, &albedo, &normal, features_are, quality.orientations));
  if (noise.without_emission) denoise::premultiply(clean, cover);
  if (noise.difference.pixels.empty()) return denoise::Shrunk{std::move(clean), 0};
  image::Image difference = denoise::with_outliers(noise.difference, picture, clean, noise.deviation);
  if (noise.of_emission) difference = with_emission_as_noise(std::move(difference));
  return denoise::shrink(picture, clean, difference);
}

image::Image PictureDenoising::noisy_emission(const image::Image& sent) const {
  double sum = 0;
  for (const Rgb& p : sent.pixels) sum += static_cast<double>(luminance(p));
  const double usual = sum / static_cast<double>(sent.pixels.size());
  return without_fireflies(denoise::reduced(features().noisy_emission, sent.width, sent.height),
                           static_cast<float>(usual));
}

image::Image PictureDenoising::with_emission_as_noise(image::Image difference) const {
  if (difference.pixels.empty()) return difference;
  const image::Image shown = denoise::reduced(features().noisy_emission, difference.width, difference.height);
  for (std::size_t p = 0; p < shown.pixels.size(); ++p)
    for (int c = 0; c < 3; ++c)
      difference.pixels[p][c] = std::abs(difference.pixels[p][c]) + 2 * shown.pixels[p][c];
  return difference;
}

image::Image PictureDenoising::enlarged(image::Image sent) const {
  const PixelFeatures features = this->features();
  if (sent.width == features.albedo.width && sent.height == features.albedo.height) return sent;
  const image::Image cover = denoise::reduced(features.cover, sent.width, sent.height);
  image::Image large = denoise::enlarged(denoise::unpremultiplied(sent, cover),
                                         denoise::unpremultiplied(features.albedo, features.cover),
                                         denoise::unpremultiplied(features.normal, features.cover));
  denoise::premultiply(large, features.cover);
  return large;
}

}  // namespace lumirank::pipeline
