// Maps from the unit square to directions and points, with their densities.
#pragma once

#include "base/vec.h"

namespace lumirank {

// Uniform on the unit disk (concentric map: keeps strata compact).
inline Vec2f warp_disk(Vec2f u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  float r, phi;
  if (std::abs(a) > std::abs(b)) {
    r = a, phi = (kPi / 4) * (b / a);
  } else {
    r = b, phi = kPi / 2 - (kPi / 4) * (a / b);
  }
  return {r * std::cos(phi), r * std::sin(phi)};
}

// Around +z with density cosθ/π.
inline Vec3f warp_cosine_hemisphere(Vec2f u) {
  const Vec2f d = warp_disk(u);
  return {d.x, d.y, std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y))};
}
inline float pdf_cosine_hemisphere(float cos_theta) { return std::max(0.0f, cos_theta) * kInvPi; }

// Uniform on the unit sphere, density 1/(4π).
inline Vec3f warp_sphere(Vec2f u) {
  const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// Uniform in the cone around +z with the given cosine of its half angle; density 1/(2π(1 - cos)).
inline Vec3f warp_cone(Vec2f u, float cos_max) {
  const float z = 1 - u.x * (1 - cos_max), r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}
inline float pdf_cone(float cos_max) { return 1 / (2 * kPi * (1 - cos_max)); }

// Barycentric coordinates (of the second and third corner) uniform on a triangle.
inline Vec2f warp_triangle(Vec2f u) {
  const float r = std::sqrt(u.x);
  return {r * (1 - u.y), r * u.y};
}

}  // namespace lumirank
