// Small values that the library speaks in.
#pragma once

namespace lumirank {

// Linear RGB (Rec. 709 primaries). Radiance, flux or reflectance: the owner says which.
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

struct Vec2f {
  float x = 0, y = 0;
  friend Vec2f operator+(Vec2f a, Vec2f b) { return {a.x + b.x, a.y + b.y}; }
  friend Vec2f operator-(Vec2f a, Vec2f b) { return {a.x - b.x, a.y - b.y}; }
  friend Vec2f operator*(Vec2f a, float s) { return {a.x * s, a.y * s}; }
  friend bool operator==(const Vec2f&, const Vec2f&) = default;
};

struct Vec3f {
  float x = 0, y = 0, z = 0;
  float operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }
  float& operator[](int i) { return i == 0 ? x : (i == 1 ? y : z); }
  friend Vec3f operator+(Vec3f a, Vec3f b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3f operator-(Vec3f a, Vec3f b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3f operator-(Vec3f a) { return {-a.x, -a.y, -a.z}; }
  friend Vec3f operator*(Vec3f a, float s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Vec3f operator*(float s, Vec3f a) { return a * s; }
  friend Vec3f operator/(Vec3f a, float s) { return a * (1.0f / s); }
  Vec3f& operator+=(Vec3f b) { return *this = *this + b; }
  friend bool operator==(const Vec3f&, const Vec3f&) = default;
};

}  // namespace lumirank
