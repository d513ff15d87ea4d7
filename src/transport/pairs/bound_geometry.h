// What the boxes of rows and of lights, as bounds see them, allow: distances, directions and cosines.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/bounds.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "scatter/lobe_bound.h"

namespace lumirank::transport {

// Entries are products of some ten floats.
inline constexpr float kBoundSlack = 1 + 4e-6f;
// Of cosines, absolutely: they are sums of three products.
inline constexpr float kCosineSlack = 3e-7f;

// The box of all differences from a row to a light.
struct Differences {
  Vec3f center, half;
  float distance2;  // least
};
inline Differences differences(const Bounds3f& rows, const Bounds3f& lights) {
  Differences d;
  const Vec3f lo = lights.lo - rows.hi, hi = lights.hi - rows.lo;
  d.distance2 = length_squared(max(max(lo, -hi), Vec3f{}));
  d.center = (lo + hi) * 0.5f;
  // Of a single pair the box is a point, whose place is exact; else there are roundings.
  d.half = (hi - lo) * 0.500001f;
  return d;
}

// Square of the greatest distance; never 0.
inline float max_distance2(const Differences& d) {
  const Vec3f farthest{std::abs(d.center.x) + d.half.x, std::abs(d.center.y) + d.half.y,
                       std::abs(d.center.z) + d.half.z};
  return std::max({length_squared(farthest), d.distance2, 1e-30f});
}

// All directions from a row to a light.
inline scatter::DirectionCone directions(const Differences& d) {
  scatter::DirectionCone cone;
  const float radius = length(d.half), far = length(d.center);
  if (far > 0) cone.axis = d.center / far;
  if (radius < far) cone.angle = radius > 0 ? std::asin(radius / far) : 0.0f;
  return cone;
}

// At least the cosine between `axis` and any w in the box of differences. Turned so that the axis is z, w has
// z of at most that of the box, and is off the axis by at least, or where all z are negative by at most, what
// the box is in the direction across in which its center lies. If all z are negative and `front`, no more is
// said.
inline float max_cosine(Vec3f axis, const Differences& d, bool front) {
  const auto extent = [&](Vec3f v) {
    return std::abs(v.x) * d.half.x + std::abs(v.y) * d.half.y + std::abs(v.z) * d.half.z;
  };
  const float z = dot(axis, d.center);
  const float top =
      z + extent(axis) + kCosineSlack * (std::abs(d.center.x) + std::abs(d.center.y) + std::abs(d.center.z));
  if (top <= 0 && front) return -1;
  const Vec3f across = d.center - axis * z;
  const float off2 = length_squared(across);
  if (top > 0) {
    const float min_off = off2 - extent(across);  // times off
    return min_off > 0 ? top / std::sqrt(top * top + min_off * min_off / off2) : 1.0f;
  }
  const float max_off = std::sqrt(off2) + length(d.half);
  return max_off > 0 ? top / std::sqrt(top * top + max_off * max_off) : -1.0f;
}

// cos(max(0, angle - spread)).
inline float towards(float cosine, float cos_spread, float sin_spread) {
  if (cos_spread >= 1) return cosine;
  if (cosine >= cos_spread) return 1;
  return cosine * cos_spread + std::sqrt(std::max(0.0f, 1 - cosine * cosine)) * sin_spread;
}
inline float sine_of(float cosine) { return std::sqrt(std::max(0.0f, 1 - cosine * cosine)); }

inline Rgb greater(Rgb a, Rgb b) { return {std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)}; }

}  // namespace lumirank::transport
