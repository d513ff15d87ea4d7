#include "pipeline/noise_metric.h"

#include "base/error.h"
#include "image/metrics.h"

namespace lumirank::pipeline {

double noise_by(ErrorMetric metric, const image::Image& picture, const image::Image& difference) {
  image::Image noisy = picture;
  for (std::size_t p = 0; p < noisy.pixels.size(); ++p) noisy.pixels[p] += difference.pixels[p] * 0.5f;
  const PictureError error = image::compare(noisy, picture);
  switch (metric) {
    case ErrorMetric::l1:
      return error.relative_l1;
    case ErrorMetric::relmse:
      return error.relmse;
    case ErrorMetric::flip:
      return error.flip;
  }
  throw InternalError("an error metric without a name");
}

std::string said_of_noise(ErrorMetric metric, const char* of) {
  const std::string noise = std::string("the noise of all ") + of + ", before a denoiser";
  return metric == ErrorMetric::relmse ? noise + ", as relMSE"
         : metric == ErrorMetric::flip ? noise + ", as FLIP"
                                       : noise;
}

void check_metric(const MethodSettings& method, bool passes_or_paths) {
  if (method.error_metric == ErrorMetric::l1) return;
  if (!(method.target_error > 0))
    throw InputError("--error-metric without --error", "give the error at which to stop");
  if (!passes_or_paths)
    throw InputError("only pictures of passes or paths know their noise as relMSE or FLIP",
                     "leave out --method, or --error-metric");
}

}  // namespace lumirank::pipeline
