// The picture of a render in passes: the mean of what surfaces send, emission and features by film samples of
// their own, and the denoiser.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "denoise/denoiser.h"
#include "image/image.h"
#include "lumirank/settings.h"
#include "methods/common/timed_choices.h"
#include "pipeline/develop.h"
#include "pipeline/picture_mean.h"
#include "pipeline/pixel_features.h"
#include "pipeline/rest_tracing.h"

namespace lumirank::pipeline {

class PassPicture {
 public:
  // Looks for the denoiser, unless settings want none; throws InputError if they demand what is not there.
  // Under a budget it is tried out, and `choices` gets what follows. Settings must outlive this.
  PassPicture(const RenderSettings& settings, const View& view, methods::TimedChoices& choices,
              const Sinks& sinks);

  std::string denoiser_version() const { return denoiser_->version(); }
  // Why there is none although one would be used; else empty.
  const std::string& denoiser_trouble() const { return trouble_; }
  // What denoising the whole film is expected to take; 0 without a budget.
  double denoiser_seconds() const { return denoiser_seconds_; }
  // What features are expected to take after the first pass, `left` seconds before the end of a budget, where
  // one film sample in each pixel takes so long.
  double feature_seconds(double one_sample, double left) const;
  // With the filter that denoised pictures have: a wider one makes the noise of neighbors alike, and a
  // denoiser takes it for shape then.
  View filtered(View view) const;

  // Pass `number` of `wanted`; `sent`: what surfaces send. `film`: as the pass had it, with a recipe whose
  // seeds are for film samples; `left`: seconds of the budget, 0 without one. False if it was cancelled.
  bool add(int number, int wanted, const image::Image& sent, const FilmInput& film, double left,
           methods::TimedChoices& choices, const Sinks& sinks);

  // Relative L1 of the mean's noise (PictureMean).
  double noise() const { return mean_.noise(); }
  // What surfaces and mirrors send, and `rest`.
  image::Image sent(const RestTracing& rest) const;
  image::Image with_emission(image::Image sent) const;
  // Without its noise; nothing if there is no denoiser, or nothing that it could do.
  std::optional<image::Image> denoised(const image::Image& sent) const;

 private:
  void try_denoiser(const View& view, methods::TimedChoices& choices);
  bool timed() const { return settings_.time > 0; }
  bool trace_features(int number, const FilmInput& film, double left, methods::TimedChoices& choices,
                      const Sinks& sinks);
  int edge_samples(double one_everywhere, double left, methods::TimedChoices& choices) const;
  struct SampleRange {
    int min, max;
  };
  int samples_for(const char* choice, double one, double left, SampleRange range,
                  methods::TimedChoices& choices) const;
  image::Image emission_of_pass(int wanted, const FilmInput& film) const;

  const RenderSettings& settings_;
  FilmParts parts_;
  std::shared_ptr<const denoise::Denoiser> denoiser_;
  std::string trouble_;
  double denoiser_seconds_ = 0;
  denoise::Features features_are_ = denoise::Features::clean;
  PictureMean mean_;                             // of what surfaces send
  PictureMean emission_;                         // without a denoiser
  std::optional<PixelFeatureTracing> features_;  // with one
};

}  // namespace lumirank::pipeline
