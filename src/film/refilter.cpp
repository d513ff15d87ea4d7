#include "film/refilter.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumirank::film {
namespace {

constexpr double kVarianceOfPixel = 1.0 / 12;
// What one averaging of three pixels adds at most, the outer ones with a sixth each: more would not fall off
// evenly.
constexpr double kMostAtOnce = 1.0 / 3;
constexpr std::size_t kRowsAtOnce = 16;

// Of each pixel and its two neighbors along x, or y. `outer`: the weight of either neighbor.
image::Image averaged(const image::Image& from, float outer, Vec2i step) {
  image::Image to(from.width, from.height);
  const auto at = [&](int x, int y) {
    return from.at(std::clamp(x, 0, from.width - 1), std::clamp(y, 0, from.height - 1));
  };
  parallel_for(static_cast<std::size_t>(from.height), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < from.width; ++x)
        to.at(x, y) = (1 - 2 * outer) * from.at(x, y) +
                      outer * (at(x - step.x, y - step.y) + at(x + step.x, y + step.y));
  });
  return to;
}

}  // namespace

double variance(const Filter& filter) {
  constexpr int kSteps = 4096;  // midpoint rule over one side
  double sum = 0, squares = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double x = (k + 0.5) / kSteps * static_cast<double>(filter.radius);
    const auto weight = static_cast<double>(filter.eval(static_cast<float>(x)));
    sum += weight, squares += weight * x * x;
  }
  return sum > 0 ? squares / sum : 0;
}

image::Image refiltered(image::Image of_box, const Filter& filter) {
  const double lacking = variance(filter) - kVarianceOfPixel;
  // Rounding of a box's own variance.
  if (!(lacking > 1e-6)) return of_box;
  const int times = static_cast<int>(std::ceil(lacking / kMostAtOnce));
  const auto outer = static_cast<float>(lacking / (2 * times));
  for (int k = 0; k < times; ++k) of_box = averaged(averaged(of_box, outer, {1, 0}), outer, {0, 1});
  return of_box;
}

}  // namespace lumirank::film
