// What a render that is finished by a denoiser does for it: finds it, keeps time for it, and traces the
// features by which it tells edges from noise.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "denoise/denoiser.h"
#include "denoise/shrinkage.h"
#include "image/image.h"
#include "lumirank/settings.h"
#include "methods/common/timed_choices.h"
#include "pipeline/pixel_features.h"

namespace lumirank::pipeline {

class PictureDenoising {
 public:
  // Of fewer paths the halves say too little of the noise to give back what is none.
  static constexpr int kPathsForNoise = 8;

  // Looks for the denoiser, unless settings want none; throws InputError if they demand what is not there.
  // Under a budget it is tried out. What follows goes into `choices`. Both must outlive this.
  PictureDenoising(const RenderSettings& settings, const View& view, methods::TimedChoices& choices,
                   const Sinks& sinks);

  bool wanted() const { return denoiser_ != nullptr; }  // and there
  // For a report: by what the picture was denoised, and why not where it would have been.
  void note(bool was_used, std::map<std::string, std::string>& notes) const;
  // What denoising the whole film is expected to take; 0 without a budget.
  double seconds() const { return seconds_; }
  // What features are expected to take after the first pass, `left` seconds before the end of a budget, where
  // one film sample in each pixel takes so long.
  double feature_seconds(double one_sample, double left) const;
  // With the filter that denoised pictures have: a wider one makes the noise of neighbors alike, and a
  // denoiser takes it for shape then.
  View filtered(View view) const;

  // Most features follow the first pass, when it is known what a pass takes; but what mirrors show of lamps
  // takes as many as there are passes. `recipe`: with a seed for film samples; `left`: seconds of the budget,
  // 0 without one. False if it was cancelled.
  bool trace_first(const world::World& world, const View& view, const Recipe& recipe, double left,
                   const Sinks& sinks);
  bool trace_another(int number, const Sinks& sinks);
  // Of all pixels; needs trace_first().
  PixelFeatures features() const { return features_->means(); }
  bool traced() const { return features_.has_value(); }

  // Without its noise; nothing if there is no denoiser, or nothing that it could do. `difference` is twice
  // the picture's noise: what is no noise stays (denoise/shrinkage.h). Empty where that is not known.
  std::optional<denoise::Shrunk> denoised(const image::Image& picture, const image::Image& difference) const;

 private:
  void try_denoiser(const View& view);
  bool timed() const { return settings_.time > 0; }
  int edge_samples(double one_everywhere, double left) const;
  struct SampleRange {
    int min, max;
  };
  int samples_for(const char* choice, double one, double left, SampleRange range) const;

  const RenderSettings& settings_;
  methods::TimedChoices& choices_;
  std::shared_ptr<const denoise::Denoiser> denoiser_;
  std::string trouble_;
  double seconds_ = 0;
  denoise::Features features_are_ = denoise::Features::clean;
  std::optional<PixelFeatureTracing> features_;
};

}  // namespace lumirank::pipeline
