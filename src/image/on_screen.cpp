#include "image/on_screen.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"

namespace lumirank::image {
namespace {

// Of an even number of values, the mean of the middle two.
double median_of(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (static_cast<double>(*std::max_element(values.begin(), middle)) + *middle);
}

}  // namespace

double exposure_for(const Image& reference) {
  std::vector<float> values;
  values.reserve(3 * reference.pixels.size());
  for (const Rgb& c : reference.pixels) values.insert(values.end(), {c.r, c.g, c.b});
  double median = values.empty() ? 0 : median_of(values);
  if (!(median > 0)) {
    std::erase_if(values, [](float v) { return !(v > 0); });
    if (values.empty()) return std::numeric_limits<double>::infinity();
    median = median_of(values);
  }
  return 0.245 / median;
}

Image on_screen(const Image& radiance, double exposure) {
  Image shown(radiance.width, radiance.height);
  parallel_for(shown.pixels.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int c = 0; c < 3; ++c) {
        const double value = radiance.pixels[i][c];
        // Written so that an infinite exposure shows white, not NaN.
        if (value > 0)
          shown.pixels[i][c] = static_cast<float>(std::min(1.0, 1.25 / (1 + 1 / (value * exposure))));
      }
  });
  return shown;
}

}  // namespace lumirank::image
