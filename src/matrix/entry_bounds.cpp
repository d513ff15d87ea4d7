#include "matrix/entry_bounds.h"

#include <algorithm>

namespace lumirank::matrix {

Cone join(const Cone& a, const Cone& b) {
  if (a.cosine <= -1 || b.cosine <= -1) return {a.axis, -1};
  const auto angle = [](float cosine) {
    return std::acos(std::clamp(static_cast<double>(cosine), -1.0, 1.0));
  };
  const double spread_a = angle(a.cosine), spread_b = angle(b.cosine), between = angle(dot(a.axis, b.axis));
  if (between + spread_b <= spread_a) return a;
  if (between + spread_a <= spread_b) return b;
  constexpr double kRounding = 1e-3;  // of axes and cosines in floats, near 0 where cosines are blunt
  const double spread = 0.5 * (spread_a + spread_b + between) + kRounding;
  if (spread >= static_cast<double>(kPi)) return {a.axis, -1};
  // Turn from axis a towards b until both lie within `spread`.
  const double turn = spread - kRounding - spread_a, sine = std::sin(between);
  const double u = sine > 1e-6 ? std::sin(between - turn) / sine : 1.0,
               v = sine > 1e-6 ? std::sin(turn) / sine : 0.0;
  const Vec3f axis = a.axis * static_cast<float>(u) + b.axis * static_cast<float>(v);
  const float size = length(axis);
  if (!(size > 1e-3f)) return {a.axis, -1};
  return {axis / size, static_cast<float>(std::cos(spread))};
}

ColumnSet join(const ColumnSet& a, const ColumnSet& b) {
  ColumnSet set = a;
  set.box.extend(b.box);
  set.cone = join(a.cone, b.cone);
  set.radius = std::max(a.radius, b.radius);
  set.least_radius = std::min(a.least_radius, b.least_radius);
  set.direct = a.direct && b.direct;
  set.intensity += b.intensity;
  set.ceiling += b.ceiling;
  return set;
}

}  // namespace lumirank::matrix
