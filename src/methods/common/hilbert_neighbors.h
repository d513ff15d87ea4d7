// Nearest neighbors by Hilbert's curve: points in the plane are sorted along it, and neighbors are found by
// walking along shifted copies of it (Liao, Lopez and Leutenegger 2001; Huo et al. 2015, section 5.1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace lumirank::methods {

// Coordinates of points in the plane through the origin across `normal`. out: one per point.
void tangent_coordinates(std::span<const Vec3f> points, Vec3f normal, std::span<Vec2f> out);

// Points of the plane sorted along three curves, shifted against each other by a third of the points' extent
// (dimensions + 1 of them), so that two near points are near on at least one. Keeps its buffers.
class HilbertCurves {
 public:
  static constexpr std::size_t kCurves = 3;

  void build(std::span<const Vec2f> points);
  // Numbers of the points in the order of a curve.
  std::span<const std::uint32_t> order(std::size_t curve) const { return order_[curve]; }
  std::span<const Vec2f> points() const { return points_; }

 private:
  std::vector<Vec2f> points_;
  std::vector<std::uint64_t> keys_;
  std::array<std::vector<std::uint32_t>, kCurves> order_;
};

// For every point its nearest sampled points, nearest first.
class SampledNeighbors {
 public:
  static constexpr std::size_t kCount = 3;
  static constexpr std::uint32_t kNone = 0xffffffffu;
  using Few = std::array<std::uint32_t, kCount>;

  // `sampled`: one flag per point. Looks at three sampled predecessors and three successors on each curve, so
  // it may miss a nearest one. A sampled point has itself first.
  void find(const HilbertCurves& curves, std::span<const std::uint8_t> sampled);
  // Without any sample yet.
  void clear(std::size_t points);
  // The same after more points have been sampled; of these it misses none. `before` may be this one.
  void extend(const SampledNeighbors& before, const HilbertCurves& curves,
              std::span<const std::uint32_t> more);
  std::span<const Few> of() const { return nearest_; }  // kNone where there are fewer samples

 private:
  std::vector<Few> nearest_;
  std::vector<std::array<float, kCount>> distance_;
  std::vector<float> farthest_;  // of the distances, by point
  std::vector<float> to_;        // distances to one sample
};

}  // namespace lumirank::methods
