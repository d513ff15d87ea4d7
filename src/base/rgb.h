// Linear RGB triples (Rec. 709 primaries). Radiance, flux or reflectance: the owner says which.
#pragma once

#include <algorithm>
#include <cmath>

namespace lumirank {

struct Rgb {
  float r = 0, g = 0, b = 0;
  Rgb() = default;
  constexpr Rgb(float r_, float g_, float b_) : r(r_), g(g_), b(b_) {}
  explicit constexpr Rgb(float v) : r(v), g(v), b(v) {}

  float operator[](int i) const { return i == 0 ? r : (i == 1 ? g : b); }
  float& operator[](int i) { return i == 0 ? r : (i == 1 ? g : b); }
  friend Rgb operator+(Rgb a, Rgb c) { return {a.r + c.r, a.g + c.g, a.b + c.b}; }
  friend Rgb operator-(Rgb a, Rgb c) { return {a.r - c.r, a.g - c.g, a.b - c.b}; }
  friend Rgb operator*(Rgb a, Rgb c) { return {a.r * c.r, a.g * c.g, a.b * c.b}; }
  friend Rgb operator/(Rgb a, Rgb c) { return {a.r / c.r, a.g / c.g, a.b / c.b}; }
  friend Rgb operator*(Rgb a, float s) { return {a.r * s, a.g * s, a.b * s}; }
  friend Rgb operator*(float s, Rgb a) { return a * s; }
  friend Rgb operator/(Rgb a, float s) { return a * (1.0f / s); }
  Rgb& operator+=(Rgb c) { return *this = *this + c; }
  Rgb& operator*=(Rgb c) { return *this = *this * c; }
  Rgb& operator*=(float s) { return *this = *this * s; }
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

inline float luminance(Rgb c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }
inline float max_component(Rgb c) { return std::max(c.r, std::max(c.g, c.b)); }
inline float mean(Rgb c) { return (c.r + c.g + c.b) * (1.0f / 3.0f); }
inline bool is_black(Rgb c) { return c.r == 0 && c.g == 0 && c.b == 0; }
inline bool is_finite(Rgb c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }
// The scalar that the papers take for an RGB entry: the 2-norm of the triple (2007, section 3.2).
inline float norm2(Rgb c) { return std::sqrt(c.r * c.r + c.g * c.g + c.b * c.b); }
inline Rgb lerp(Rgb a, Rgb b, float t) { return a + (b - a) * t; }
inline Rgb clamp_below(Rgb c, float hi) { return {std::min(c.r, hi), std::min(c.g, hi), std::min(c.b, hi)}; }
inline Rgb sqrt(Rgb c) { return {std::sqrt(c.r), std::sqrt(c.g), std::sqrt(c.b)}; }

}  // namespace lumirank
