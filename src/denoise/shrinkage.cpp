#include "denoise/shrinkage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::denoise {
namespace {

constexpr float kDeviation = 2, kWideDeviation = 8;        // pixels
constexpr float kCloseDeviation = 0.7f, kCloseCounts = 2;  // see shrink()
constexpr float kNoiseCounts = 3;                          // see shrink()
constexpr float kAroundCounts = 0.125f;                    // see shrink()
constexpr float kOfUsual = 0.01f;                          // brightness that counts at least, of the mean
constexpr std::size_t kLinesAtOnce = 16;
constexpr float kDarkest = 1e-30f;  // black pictures

using Plane = std::vector<float>;

// Over the pixels that are there.
Plane blurred(const Plane& plane, int width, int height, float deviation) {
  const int reach = static_cast<int>(3 * deviation);
  std::vector<float> weight(static_cast<std::size_t>(2 * reach + 1));
  for (int k = -reach; k <= reach; ++k)
    weight[static_cast<std::size_t>(k + reach)] =
        std::exp(-0.5f * static_cast<float>(k * k) / (deviation * deviation));
  const auto along = [&](const Plane& from, std::size_t lines, int length, std::size_t step,
                         std::size_t next) {
    Plane to(from.size());
    parallel_for(lines, kLinesAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t line = begin; line < end; ++line)
        for (int i = 0; i < length; ++i) {
          float sum = 0, weights = 0;
          for (int k = std::max(-reach, -i); k <= std::min(reach, length - 1 - i); ++k) {
            const float w = weight[static_cast<std::size_t>(k + reach)];
            sum += w * from[line * next + static_cast<std::size_t>(i + k) * step];
            weights += w;
          }
          to[line * next + static_cast<std::size_t>(i) * step] = sum / weights;
        }
    });
    return to;
  };
  const auto rows = static_cast<std::size_t>(height), columns = static_cast<std::size_t>(width);
  return along(along(plane, rows, width, 1, columns), columns, height, columns, 1);
}

float square_sum(Rgb c) { return c.r * c.r + c.g * c.g + c.b * c.b; }

}  // namespace

Shrunk shrink(const image::Image& noisy, const image::Image& denoised, const image::Image& difference) {
  const std::size_t pixels = noisy.pixels.size();
  if (denoised.pixels.size() != pixels || difference.pixels.size() != pixels)
    throw InternalError("shrink: pictures of different sizes");
  Shrunk shrunk{denoised, 0};
  if (pixels == 0) return shrunk;
  Plane brightness(pixels), noise(pixels), distance(pixels);
  double sum = 0;
  for (std::size_t p = 0; p < pixels; ++p) {
    brightness[p] = std::max(0.0f, (denoised.pixels[p].r + denoised.pixels[p].g + denoised.pixels[p].b) / 3);
    sum += static_cast<double>(brightness[p]);
  }
  const float least = std::max(kDarkest, kOfUsual * static_cast<float>(sum / static_cast<double>(pixels)));
  brightness = blurred(brightness, noisy.width, noisy.height, kDeviation);
  for (std::size_t p = 0; p < pixels; ++p) {
    const float scale = 1 / (brightness[p] + least);
    noise[p] = square_sum(difference.pixels[p] * (0.5f * scale));
    distance[p] = square_sum((noisy.pixels[p] - denoised.pixels[p]) * scale);
  }
  const Plane around = blurred(noise, noisy.width, noisy.height, kWideDeviation);
  noise = blurred(noise, noisy.width, noisy.height, kDeviation);
  const Plane close = blurred(distance, noisy.width, noisy.height, kCloseDeviation);
  distance = blurred(distance, noisy.width, noisy.height, kDeviation);
  for (std::size_t p = 0; p < pixels; ++p) distance[p] = std::min(distance[p], kCloseCounts * close[p]);
  for (std::size_t p = 0; p < pixels; ++p) noise[p] = std::max(noise[p], kAroundCounts * around[p]);
  double kept = 0;
  for (std::size_t p = 0; p < pixels; ++p) {
    // Written so that what is not finite keeps nothing.
    if (!(distance[p] > kNoiseCounts * noise[p])) continue;
    const float weight = 1 - kNoiseCounts * noise[p] / distance[p];
    shrunk.picture.pixels[p] += (noisy.pixels[p] - denoised.pixels[p]) * weight;
    kept += static_cast<double>(weight);
  }
  shrunk.kept = kept / static_cast<double>(pixels);
  return shrunk;
}

}  // namespace lumirank::denoise
