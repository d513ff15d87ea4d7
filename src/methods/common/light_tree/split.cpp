#include "methods/common/light_tree/split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace lumirank::methods {
namespace {

constexpr int kBins = 16, kAxes = 6;
constexpr std::size_t kPiece = 1 << 15;

float coordinate(const SplitLight& light, int axis) {
  return axis < 3 ? light.position[axis] : light.direction[axis - 3];
}

struct Extent {
  Bounds3f places, directions;
  double intensity = 0;
  std::size_t count = 0;

  void add(const SplitLight& light) {
    places.extend(light.position), directions.extend(light.direction);
    intensity += static_cast<double>(light.intensity), ++count;
  }
  friend Extent operator+(Extent a, const Extent& b) {
    a.places.extend(b.places), a.directions.extend(b.directions);
    a.intensity += b.intensity, a.count += b.count;
    return a;
  }
  double cost(double across2) const {
    if (count == 0) return 0;
    const auto diagonal2 = static_cast<double>(length_squared(places.diagonal()));
    // Directions an angle β to either side of their mean are 2·sin β apart; wider boxes hold more than a
    // hemisphere.
    const auto chord2 = static_cast<double>(length_squared(directions.diagonal()));
    const double turn = chord2 < 4 ? 1 - std::sqrt(1 - 0.25 * chord2) : std::sqrt(chord2) - 1;
    return intensity * (diagonal2 + across2 * turn * turn);
  }
};

using Bins = std::array<std::array<Extent, kBins>, kAxes>;
struct Grid {
  std::array<float, kAxes> lo, per_width;
  int bin(const SplitLight& light, int axis) const {
    const auto a = static_cast<std::size_t>(axis);
    return std::clamp(static_cast<int>((coordinate(light, axis) - lo[a]) * per_width[a]), 0, kBins - 1);
  }
};

Bins fill(std::span<const SplitLight> lights, const Grid& grid) {
  Bins bins;
  for (int axis = 0; axis < kAxes; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (!(grid.per_width[a] > 0)) continue;
    for (const SplitLight& light : lights)
      bins[a][static_cast<std::size_t>(grid.bin(light, axis))].add(light);
  }
  return bins;
}

template <typename T, typename Piece, typename Join>
T in_pieces(std::span<const SplitLight> lights, Piece&& piece, Join&& join) {
  if (lights.size() <= kPiece) return piece(lights);
  std::vector<T> parts((lights.size() + kPiece - 1) / kPiece);
  parallel_for(lights.size(), kPiece,
               [&](std::size_t b, std::size_t e) { parts[b / kPiece] = piece(lights.subspan(b, e - b)); });
  for (std::size_t k = 1; k < parts.size(); ++k) join(parts[0], parts[k]);
  return parts[0];
}

}  // namespace

std::size_t split_lights(std::span<SplitLight> lights, float across) {
  if (lights.size() == 2) return 1;
  const Extent all = in_pieces<Extent>(
      lights,
      [](std::span<const SplitLight> part) {
        Extent extent;
        for (const SplitLight& light : part) extent.add(light);
        return extent;
      },
      [](Extent& a, const Extent& b) { a = a + b; });
  Grid grid{};
  for (int axis = 0; axis < kAxes; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const float lo = axis < 3 ? all.places.lo[axis] : all.directions.lo[axis - 3];
    const float hi = axis < 3 ? all.places.hi[axis] : all.directions.hi[axis - 3];
    grid.lo[a] = lo;
    grid.per_width[a] = hi > lo ? std::min(static_cast<float>(kBins) / (hi - lo), 1e30f) : 0.0f;
  }
  const Bins bins = in_pieces<Bins>(
      lights, [&](std::span<const SplitLight> part) { return fill(part, grid); },
      [](Bins& a, const Bins& b) {
        for (std::size_t axis = 0; axis < kAxes; ++axis)
          for (std::size_t k = 0; k < kBins; ++k) a[axis][k] = a[axis][k] + b[axis][k];
      });
  const double across2 = square(across);
  double best = kInfinity;
  int best_axis = -1, best_bin = 0;
  for (int axis = 0; axis < kAxes; ++axis) {
    const auto& row = bins[static_cast<std::size_t>(axis)];
    std::array<double, kBins> after;
    Extent sum;
    for (std::size_t k = kBins - 1; k > 0; --k) sum = sum + row[k], after[k] = sum.cost(across2);
    sum = {};
    for (std::size_t k = 0; k + 1 < kBins; ++k) {
      sum = sum + row[k];
      if (sum.count == 0 || sum.count == lights.size()) continue;
      const double cost = sum.cost(across2) + after[k + 1];
      if (cost < best) best = cost, best_axis = axis, best_bin = static_cast<int>(k);
    }
  }
  if (best_axis < 0) return lights.size() / 2;  // all alike
  const auto middle = std::partition(lights.begin(), lights.end(), [&](const SplitLight& light) {
    return grid.bin(light, best_axis) <= best_bin;
  });
  return static_cast<std::size_t>(middle - lights.begin());
}

}  // namespace lumirank::methods
