// Places on a line by their distance to a point: Kulla, Fajardo, "Importance sampling techniques for path
// tracing in participating media", 2012.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace lumirank {

struct RayPlace {
  float t = 0;    // along the ray
  float pdf = 0;  // per length; 0: nothing can be drawn
};

// On origin + t·direction, 0 ≤ t ≤ length, with a density in proportion to 1/d² from `point`.
inline RayPlace sample_equiangular(Vec3f origin, Vec3f direction, float length, Vec3f point, float u) {
  const float closest = dot(point - origin, direction);
  const float h = std::max(lumirank::length(point - origin - direction * closest), 1e-6f * length);
  const float begin = std::atan((0 - closest) / h), end = std::atan((length - closest) / h);
  if (!(end > begin)) return {};
  const float along = h * std::tan(begin + (end - begin) * u);
  return {std::clamp(closest + along, 0.0f, length), h / ((end - begin) * (h * h + along * along))};
}

inline float pdf_equiangular(Vec3f origin, Vec3f direction, float length, Vec3f point, float t) {
  const float closest = dot(point - origin, direction);
  const float h = std::max(lumirank::length(point - origin - direction * closest), 1e-6f * length);
  const float begin = std::atan((0 - closest) / h), end = std::atan((length - closest) / h);
  if (!(end > begin)) return 0;
  return h / ((end - begin) * (h * h + (t - closest) * (t - closest)));
}

}  // namespace lumirank
