#include "denoise/overshoot.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::denoise {
namespace {

constexpr int kReach = 2;     // pixels
constexpr float kBright = 4;  // over the mean
constexpr std::size_t kLinesOfTask = 16;

// Of every pixel the greatest of those up to kReach away, along a line and then across.
std::vector<float> greatest_around(const std::vector<float>& values, int width, int height) {
  const auto over = [&](const std::vector<float>& from, int step_x, int step_y) {
    std::vector<float> to(from.size());
    parallel_for(static_cast<std::size_t>(height), kLinesOfTask, [&](std::size_t begin, std::size_t end) {
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
        for (int x = 0; x < width; ++x) {
          float most = 0;
          for (int k = -kReach; k <= kReach; ++k) {
            const int i = std::clamp(x + k * step_x, 0, width - 1),
                      j = std::clamp(y + k * step_y, 0, height - 1);
            most = std::max(most, from[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                                       static_cast<std::size_t>(i)]);
          }
          to[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
              most;
        }
    });
    return to;
  };
  return over(over(values, 1, 0), 0, 1);
}

}  // namespace

image::Image without_overshoot(const image::Image& noisy, image::Image denoised) {
  if (noisy.width != denoised.width || noisy.height != denoised.height)
    throw InternalError("denoise::without_overshoot: pictures of two sizes");
  std::vector<float> brightness;
  brightness.reserve(noisy.pixels.size());
  double sum = 0;
  for (const Rgb& p : noisy.pixels) {
    brightness.push_back(luminance(p));
    sum += static_cast<double>(brightness.back());
  }
  const auto bright =
      static_cast<float>(kBright * sum / static_cast<double>(std::max<std::size_t>(1, brightness.size())));
  const std::vector<float> most = greatest_around(brightness, noisy.width, noisy.height);
  for (std::size_t p = 0; p < most.size(); ++p) {
    const float here = luminance(denoised.pixels[p]);
    if (most[p] >= bright && here > most[p]) denoised.pixels[p] *= most[p] / here;
  }
  return denoised;
}

}  // namespace lumirank::denoise
