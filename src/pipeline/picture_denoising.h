// What a render that is finished by a denoiser does for it: finds it, keeps time for it, and traces the
// features by which it tells edges from noise.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "denoise/denoiser.h"
#include "denoise/shrinkage.h"
#include "film/filter.h"
#include "image/image.h"
#include "lumirank/settings.h"
#include "methods/common/timed_choices.h"
#include "pathtrace/reference.h"
#include "pipeline/pixel_features.h"

namespace lumirank::pipeline {

// What the paths say of the picture, without fireflies (denoise/fireflies.h); with the emission that they
// see, or what surfaces send alone.
image::Image without_fireflies(const pathtrace::PathFilm& film, bool with_emission);

// What is known of the noise of a picture that is to be denoised.
struct SampledNoise {
  image::Image difference;       // of halves of what was sampled: twice the noise; empty: not known
  std::vector<float> deviation;  // of each pixel's luminance, as its own paths say; empty: not known
  bool of_emission = false;      // all emission that few film samples find is noise as well
  // The picture lacks PixelFeatures::emission.
  bool without_emission = false;
};

class PictureDenoising {
 public:
  // Of fewer paths the halves say too little of the noise to give back what is none.
  static constexpr int kPathsForNoise = 8;

  // Looks for the denoiser, unless settings want none; throws InputError if they demand what is not there.
  // Under a budget it is tried out, unless `pixel_seconds` is what it took another time. What follows goes
  // into `choices`. Both must outlive this.
  PictureDenoising(const RenderSettings& settings, const View& view, methods::TimedChoices& choices,
                   const Sinks& sinks, double pixel_seconds = 0);

  bool wanted() const { return denoiser_ != nullptr; }     // and there
  double pixel_seconds() const { return pixel_seconds_; }  // 0: not known
  // For a report: by what the picture was denoised, and why not where it would have been.
  void note(bool was_used, std::map<std::string, std::string>& notes) const;
  // The picture is rendered with so many times fewer pixels a side, and enlarged by features of all pixels.
  void make_smaller(int divisor) { divisor_ = divisor; }
  // What denoising the film is expected to take, as well as a budget pays for; 0 without one.
  double seconds() const;
  // Of the features' film samples: one for each pixel of a part or a smaller copy of the view, as measured. 0
  // where none are wanted.
  double seconds_of_feature(const world::World& world, const View& view, const Recipe& recipe,
                            const Sinks& sinks) const;
  // What features are expected to take, `left` seconds before the end of a budget, where
  // one film sample in each pixel takes so long.
  double feature_seconds(double one_sample, double left) const;
  // With the filter that denoised pictures have: a wider one makes the noise of neighbors alike, and a
  // denoiser takes it for shape then.
  View filtered(View view) const;
  // What the asked view has, where pictures of filtered() views have the box in its place.
  std::optional<film::Filter> lacking_filter() const;

  // Most features follow the first pass, when it is known what a pass takes; but what mirrors show of lamps
  // takes as many as there are passes. `view`: the whole one, also where the picture is smaller; `recipe`:
  // with a seed for film samples; `left`: seconds of the budget, 0 without one. False if it was cancelled.
  bool trace_first(const world::World& world, const View& view, const Recipe& recipe, double left,
                   const Sinks& sinks);
  bool trace_another(int number, const Sinks& sinks);
  // Of all pixels; needs trace_first().
  PixelFeatures features() const { return features_->means(); }
  // What mirrors, glass and lenses out of focus show of lamps, of the size of `sent`, what surfaces send:
  // without outliers of what is usual in there. Needs trace_first().
  image::Image noisy_emission(const image::Image& sent) const;
  // A difference of halves (twice the noise) of a picture to which that was added, all of it for noise: that
  // of few film samples is not known. Nothing of nothing.
  image::Image with_emission_as_noise(image::Image difference) const;
  bool traced() const { return features_.has_value(); }

  // Without its noise; nothing if there is no denoiser, or nothing that it could do. What is no noise
  // stays (denoise/shrinkage.h). `unspent`: seconds of the budget that nothing else needs.
  std::optional<denoise::Shrunk> denoised(const image::Image& picture, const SampledNoise& noise,
                                          double unspent) const;
  // Made as large as the features, if it has fewer pixels: without emission that is seen straight, and
  // denoised. Needs trace_first().
  image::Image enlarged(image::Image sent) const;

 private:
  // Features that are called clean are denoised with by a larger network; and the mean of several
  // orientations has less of what is wrong in each. Both take longer.
  struct Quality {
    bool clean = true;
    int orientations = 2;
    double times() const;  // as long as noisy features in one orientation
  };

  void try_denoiser(const View& view);
  // Noisy features in one orientation, of the film that is rendered.
  double seconds_once() const { return seconds_of_whole_ / (divisor_ * divisor_); }
  // What a budget pays for; and what it pays for at last.
  Quality expected_quality() const;
  Quality chosen_quality(double unspent) const;
  int samples_everywhere() const;
  bool timed() const { return settings_.time > 0; }
  // Of each pixel at an edge, where one in all of them takes so long.
  int edge_samples(double one, double left) const;
  struct SampleRange {
    int min, max;
  };
  int samples_for(const char* choice, double one, double left, SampleRange range) const;

  const RenderSettings& settings_;
  methods::TimedChoices& choices_;
  std::shared_ptr<const denoise::Denoiser> denoiser_;
  std::string trouble_;
  film::Filter asked_filter_;
  double pixel_seconds_ = 0, seconds_of_whole_ = 0;  // of a pixel, of the whole film, once
  int divisor_ = 1;
  std::optional<PixelFeatureTracing> features_;
};

}  // namespace lumirank::pipeline
