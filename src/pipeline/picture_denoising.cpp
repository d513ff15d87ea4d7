#include "pipeline/picture_denoising.h"

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

}  // namespace

PictureDenoising::PictureDenoising(const RenderSettings& settings, const View& view,
                                   methods::TimedChoices& choices, const Sinks& sinks)
    : settings_(settings), choices_(choices) {
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
  const image::Image trial(kDenoiserTrial, kDenoiserTrial, Rgb(0.5f));
  denoiser_->denoise(trial, &trial, &trial);  // the first time everything takes longer
  const Timer timer;
  denoiser_->denoise(trial, &trial, &trial);
  seconds_ = kDenoiserMargin * timer.seconds() * static_cast<double>(view.width) *
             static_cast<double>(view.height) / (kDenoiserTrial * kDenoiserTrial);
  bool clean = kCleanOverNoisy * seconds_ <= kTimeOfClean * settings_.time;
  if (const auto earlier = choices_.earlier("clean_features", 1)) clean = *earlier == 1;
  choices_.record("clean_features", clean ? 1 : 0);
  if (clean)
    seconds_ *= kCleanOverNoisy;
  else
    features_are_ = denoise::Features::noisy;
}

double PictureDenoising::feature_seconds(double one_sample, double left) const {
  if (!denoiser_) return 0;
  return PixelFeatureTracing::kEverywhere * one_sample + kTimeOfEdges * std::max(0.0, left);
}

View PictureDenoising::filtered(View view) const {
  if (denoiser_) view.sensor.film.filter = scenedesc::FilterDesc{.kind = scenedesc::FilterKind::box};
  return view;
}

bool PictureDenoising::trace_first(const world::World& world, const View& view, const Recipe& recipe,
                                   double left, const Sinks& sinks) {
  const Timer timer;
  features_.emplace(world, view, recipe);
  if (!features_->trace_all(sinks)) return false;
  const double one = timer.seconds() / PixelFeatureTracing::kEverywhere;  // in each pixel
  if (!features_->trace_differing(edge_samples(one, left), sinks)) return false;
  const int glaring = samples_for("glaring_samples", one * features_->glaring(), left, {0, kGlaringSamples});
  return settings_.view.film_samples || features_->trace_glaring(glaring, sinks);
}

bool PictureDenoising::trace_another(int number, const Sinks& sinks) {
  return number < kEdgeSamples || features_->trace_another(static_cast<std::uint64_t>(number), sinks);
}

int PictureDenoising::edge_samples(double one_everywhere, double left) const {
  if (settings_.view.film_samples)
    return std::max(0, *settings_.view.film_samples - PixelFeatureTracing::kEverywhere);
  return samples_for("edge_samples", one_everywhere * features_->differing(), left,
                     {kMinEdgeSamples, kEdgeSamples});
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
                                                          const image::Image& difference) const {
  if (!features_ || std::min(picture.width, picture.height) < kSmallestDenoised ||
      std::all_of(picture.pixels.begin(), picture.pixels.end(), [](Rgb c) { return is_black(c); }))
    return {};
  const PixelFeatures features = this->features();
  image::Image clean = denoiser_->denoise(picture, &features.albedo, &features.normal, features_are_);
  if (difference.pixels.empty()) return denoise::Shrunk{std::move(clean), 0};
  return denoise::shrink(picture, clean, difference);
}

}  // namespace lumirank::pipeline
