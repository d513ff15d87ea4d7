#include "matrix/entry_bounds.h"

#include <algorithm>

namespace lumirank::matrix {

namespace {

// What rounding an axis and a cosine to floats may cost, as a cosine. As an angle it is the less the blunter
// the cone, so that many joins one after the other cost no more than a few.
constexpr double kRounding = 4e-7;

struct Vec3d {
  double x, y, z;
};
Vec3d unit(Vec3f v) {
  const double x = v.x, y = v.y, z = v.z, size = std::sqrt(x * x + y * y + z * z);
  return {x / size, y / size, z / size};
}
double angle(float cosine) { return std::acos(std::clamp(static_cast<double>(cosine), -1.0, 1.0)); }
// Precise for nearly equal vectors as well.
double angle(Vec3d a, Vec3d b) {
  const double x = a.y * b.z - a.z * b.y, y = a.z * b.x - a.x * b.z, z = a.x * b.y - a.y * b.x;
  return std::atan2(std::sqrt(x * x + y * y + z * z), a.x * b.x + a.y * b.y + a.z * b.z);
}

}  // namespace

Cone join(const Cone& a, const Cone& b) {
  if (a.cosine <= -1 || b.cosine <= -1) return {a.axis, -1};
  if (a.axis == b.axis) return {a.axis, std::min(a.cosine, b.cosine)};
  const Vec3d u = unit(a.axis), v = unit(b.axis);
  const double spread_a = angle(a.cosine), spread_b = angle(b.cosine), between = angle(u, v);
  if (between + spread_b <= spread_a) return a;
  if (between + spread_a <= spread_b) return b;
  const double spread = 0.5 * (spread_a + spread_b + between);
  constexpr double kHalfTurn = 3.14159265358979324;
  if (spread >= kHalfTurn) return {a.axis, -1};
  // Turn from axis a towards b until both lie within `spread`.
  const double turn = spread - spread_a, sine = std::sin(between);
  if (!(sine > 1e-9)) {
    // Opposite axes, or as good as equal ones.
    return between > 1 ? Cone{a.axis, -1}
                       : Cone{a.axis, static_cast<float>(std::cos(2 * spread) - kRounding)};
  }
  const double p = std::sin(between - turn) / sine, q = std::sin(turn) / sine;
  const Vec3f axis{static_cast<float>(p * u.x + q * v.x), static_cast<float>(p * u.y + q * v.y),
                   static_cast<float>(p * u.z + q * v.z)};
  return {axis, std::max(-1.0f, static_cast<float>(std::cos(spread) - kRounding))};
}

ColumnSet join(const ColumnSet& a, const ColumnSet& b) {
  ColumnSet set = a;
  set.box.extend(b.box);
  set.cone = join(a.cone, b.cone);
  set.radius = std::max(a.radius, b.radius);
  set.min_radius = std::min(a.min_radius, b.min_radius);
  set.min_length = std::min(a.min_length, b.min_length);
  set.direct = a.direct && b.direct;
  set.intensity += b.intensity;
  set.ceiling += b.ceiling;
  return set;
}

}  // namespace lumirank::matrix
