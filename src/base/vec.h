// Small fixed-size vectors of floats: the currency of every other room.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lumirank/values.h"

namespace lumirank {

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr double kPiD = 3.14159265358979323846;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInfinity = __builtin_huge_valf();

struct Vec2i {
  int x = 0, y = 0;
  friend bool operator==(const Vec2i&, const Vec2i&) = default;
};

// A place as a scene file states it: far from the origin 32 bits would not hold what its numbers say.
struct Vec3d {
  double x = 0, y = 0, z = 0;
  constexpr Vec3d() = default;
  constexpr Vec3d(double a, double b, double c) : x(a), y(b), z(c) {}
  constexpr Vec3d(Vec3f v) : x(v.x), y(v.y), z(v.z) {}  // NOLINT: nothing is lost
  explicit constexpr operator Vec3f() const {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
  }
  double operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }
  double& operator[](int i) { return i == 0 ? x : (i == 1 ? y : z); }
  friend Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
  friend bool operator==(const Vec3d&, const Vec3d&) = default;
};

inline float dot(Vec3f a, Vec3f b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3f cross(Vec3f a, Vec3f b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length_squared(Vec3f a) { return dot(a, a); }
inline float length(Vec3f a) { return std::sqrt(dot(a, a)); }
inline Vec3f normalize(Vec3f a) { return a / length(a); }
inline Vec3f min(Vec3f a, Vec3f b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
inline Vec3f max(Vec3f a, Vec3f b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
inline bool is_finite(Vec3f a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
inline float square(float x) { return x * x; }
inline float lerp(float a, float b, float t) { return a + (b - a) * t; }
inline Vec3f lerp(Vec3f a, Vec3f b, float t) { return a + (b - a) * t; }

inline bool is_finite(Vec3d a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

// Mirror image of `w` about `n` (both pointing away from the surface).
inline Vec3f reflect(Vec3f w, Vec3f n) { return n * (2 * dot(w, n)) - w; }

}  // namespace lumirank
