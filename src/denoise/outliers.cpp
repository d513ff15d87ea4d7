#include "denoise/outliers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/error.h"

namespace lumirank::denoise {
namespace {

constexpr float kOutlierBrighter = 3, kOutlierDeviations = 3;

}  // namespace

image::Image with_outliers(image::Image difference, const image::Image& noisy, const image::Image& denoised,
                           std::span<const float> deviation) {
  if (deviation.empty()) return difference;
  const std::size_t size = noisy.pixels.size();
  if (difference.pixels.size() != size || denoised.pixels.size() != size || deviation.size() != size)
    throw InternalError("denoise::with_outliers: pictures of different sizes");
  for (std::size_t p = 0; p < size; ++p) {
    const float here = luminance(noisy.pixels[p]), clean = luminance(denoised.pixels[p]);
    if (!(here > kOutlierBrighter * clean) || here - clean > kOutlierDeviations * deviation[p]) continue;
    for (int c = 0; c < 3; ++c) {
      float& d = difference.pixels[p][c];
      d = std::max(std::abs(d), 2 * deviation[p] * noisy.pixels[p][c] / here);
    }
  }
  return difference;
}

}  // namespace lumirank::denoise
