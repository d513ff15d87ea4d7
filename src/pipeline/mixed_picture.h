// The picture of a render in passes, with which the one of paths may be mixed that go on after the first of
// them: what is sent, emission, and the noise of both.
#pragma once

#include "lumirank/settings.h"
#include "pipeline/pass_picture.h"
#include "pipeline/paths_beside.h"
#include "pipeline/rest_tracing.h"

namespace lumirank::pipeline {

class MixedPicture {
 public:
  // What is given by reference must outlive this.
  MixedPicture(const PassPicture& passes, const RestTracing& rest) : passes_(passes), rest_(rest) {}

  // From now on by paths, which must outlive this: with their own emission, or that of film samples.
  void go_on_by(const PathsBeside& paths, bool own_emission) {
    paths_ = &paths, own_emission_ = own_emission;
  }
  // What passes count for in the mean with them, in 0 … 1.
  void set_share_of_passes(float share) { share_ = share; }
  bool by_paths() const { return paths_ != nullptr; }
  float share_of_passes() const { return share_; }

  // What surfaces send, and that of mirrors and glass.
  image::Image sent() const;
  // What has noise: as it is, and without fireflies.
  image::Image with_all_noise() const;
  image::Image to_denoise() const;
  // One of these with the emission that it lacks.
  image::Image complete(image::Image image) const;
  image::Image enlarged(image::Image image) const;
  // Twice the noise of what is denoised; empty where it is not known well: halves of few passes may agree on
  // a speck, which would stay. Of what was sampled, and with what mirrors show of lamps where that is noise.
  SampledNoise sampled_noise() const;
  image::Image difference() const;
  // As the metric counts it.
  double noise(ErrorMetric metric) const;

 private:
  bool has_own_emission() const { return by_paths() && own_emission_; }
  image::Image with_share(image::Image of_paths) const;
  image::Image with_share_and_emission(image::Image of_paths) const;
  image::Image with_share_of_noise(image::Image of_paths) const;
  image::Image shared(image::Image of_paths, const image::Image& of_passes) const;

  const PassPicture& passes_;
  const RestTracing& rest_;
  const PathsBeside* paths_ = nullptr;
  bool own_emission_ = false;
  float share_ = 0;
};

}  // namespace lumirank::pipeline
