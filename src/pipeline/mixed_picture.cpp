#include "pipeline/mixed_picture.h"

#include <cmath>

#include "pipeline/noise_metric.h"
#include "pipeline/path_run.h"

namespace lumirank::pipeline {

image::Image MixedPicture::sent() const {
  return passes_.with_noisy_emission(by_paths() ? with_share(paths_->sent()) : passes_.sent(rest_));
}
image::Image MixedPicture::with_all_noise() const {
  return has_own_emission() ? with_share_and_emission(paths_->picture()) : sent();
}
image::Image MixedPicture::to_denoise() const {
  if (!by_paths()) return with_all_noise();
  image::Image clean = without_fireflies(paths_->film(), has_own_emission());
  return has_own_emission() ? with_share_and_emission(std::move(clean))
                            : passes_.with_noisy_emission(with_share(std::move(clean)));
}
image::Image MixedPicture::complete(image::Image image) const {
  return has_own_emission() ? image : passes_.with_emission(std::move(image));
}
image::Image MixedPicture::enlarged(image::Image image) const {
  return passes_.enlarged_with_emission(std::move(image));
}

SampledNoise MixedPicture::sampled_noise() const {
  SampledNoise noise;
  noise.without_emission = !has_own_emission();
  if (!by_paths() || paths_->paths() < PictureDenoising::kPathsForNoise) return noise;
  noise.difference =
      with_share_of_noise(has_own_emission() ? paths_->difference() : paths_->sent_difference());
  noise.deviation = paths_->film().sent_deviation();
  for (float& deviation : noise.deviation) deviation *= 1 - share_;
  noise.of_emission = !own_emission_;
  return noise;
}
image::Image MixedPicture::difference() const {
  SampledNoise noise = sampled_noise();
  return noise.of_emission ? passes_.with_emission_as_noise(std::move(noise.difference)) : noise.difference;
}
double MixedPicture::noise(ErrorMetric metric) const {
  if (metric == ErrorMetric::l1) {
    const double of_passes = passes_.noise(), share = share_;
    return by_paths() ? std::hypot((1 - share) * paths_->error(), share * of_passes) : of_passes;
  }
  if (by_paths())
    return noise_by(metric, with_share_and_emission(paths_->picture()),
                    with_share_of_noise(paths_->difference()));
  const NoisyPicture passes = passes_.with_noise(rest_);
  return noise_by(metric, passes.picture, passes.difference);
}

// The mean of paths and passes: without emission, with it, and of differences.
image::Image MixedPicture::with_share(image::Image of_paths) const {
  if (share_ == 0) return of_paths;
  return shared(std::move(of_paths), passes_.sent(rest_));
}
image::Image MixedPicture::with_share_and_emission(image::Image of_paths) const {
  if (share_ == 0) return of_paths;
  return shared(std::move(of_paths), passes_.with_emission(passes_.with_noisy_emission(passes_.sent(rest_))));
}
image::Image MixedPicture::with_share_of_noise(image::Image of_paths) const {
  if (share_ == 0) return of_paths;
  return shared(std::move(of_paths), passes_.with_noise(rest_).difference);
}
image::Image MixedPicture::shared(image::Image of_paths, const image::Image& of_passes) const {
  for (std::size_t p = 0; p < of_paths.pixels.size(); ++p)
    of_paths.pixels[p] += share_ * (of_passes.pixels[p] - of_paths.pixels[p]);
  return of_paths;
}

}  // namespace lumirank::pipeline
