// Where along rays the integrals of pairs with a ray in them are sampled.
//
// A point and a ray: equiangular (base/equiangular.h). Two rays: jointly, first on the light by the integral
// of 1/d² over the whole of the other line, then equiangular on the other (Novák et al. 2012, section 4.2:
// "joint importance sampling" for isotropic media).
#pragma once

#include <algorithm>
#include <cmath>

#include "base/equiangular.h"
#include "base/vec.h"

namespace lumirank::transport {

// On the first of two rays, with a density in proportion to 1/(distance to the second's line):
// ∫ 1/d² over a line is π over the distance to it.
inline RayPlace sample_near_line(Vec3f origin, Vec3f direction, float length, Vec3f line_origin,
                                 Vec3f line_direction, float u) {
  // The distance of origin + t·direction to the line is √(h² + sin²·(t - closest)²).
  const Vec3f normal = cross(direction, line_direction);
  const float sine2 = length_squared(normal);
  if (!(sine2 > 1e-8f)) return {u * length, 1 / length};  // parallel: it is the same everywhere
  const float sine = std::sqrt(sine2);
  const Vec3f between = line_origin - origin;
  const float closest = dot(cross(between, line_direction), normal) / sine2;
  const float h = std::max(std::abs(dot(between, normal)) / sine, 1e-6f * length);
  const float scale = sine / h;
  const float begin = std::asinh((0 - closest) * scale), end = std::asinh((length - closest) * scale);
  if (!(end > begin)) return {};
  const float along = std::sinh(begin + (end - begin) * u) / scale;
  return {std::clamp(closest + along, 0.0f, length),
          scale / ((end - begin) * std::sqrt(1 + square(along * scale)))};
}

}  // namespace lumirank::transport
