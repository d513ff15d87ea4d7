#include "emitters/light_bound.h"

#include <algorithm>
#include <cmath>

namespace lumirank::emitters {

namespace {

// Added to an angle that was found by rounded arithmetic.
constexpr double kAngleSlack = 1e-4;

// Exact for small angles too, where acos of a rounded cosine is not.
double angle_between(Vec3f a, Vec3f b) { return 2 * std::atan2(length(a - b), length(a + b)); }

// `a` turned by `angle` towards `b`, which lies at the angle `between`.
Vec3f turned(Vec3f a, Vec3f b, double angle, double between) {
  const double s = std::sin(between);
  if (!(s > 1e-6)) return a;
  return normalize(a * static_cast<float>(std::sin(between - angle) / s) +
                   b * static_cast<float>(std::sin(angle) / s));
}

}  // namespace

LightBound join(const LightBound& a, const LightBound& b) {
  if (!(a.intensity > 0)) return b;
  if (!(b.intensity > 0)) return a;
  const LightBound& wide = a.spread >= b.spread ? a : b;
  const LightBound& narrow = a.spread >= b.spread ? b : a;
  LightBound out = wide;
  out.bounds.extend(narrow.bounds);
  out.reach = std::max(a.reach, b.reach);
  out.intensity = a.intensity + b.intensity;
  const double between = angle_between(wide.axis, narrow.axis);
  if (between + narrow.spread <= wide.spread) return out;
  const double spread = (wide.spread + between + narrow.spread) / 2 + kAngleSlack;
  if (between < 1e-6) {
    out.spread = std::min(kPi, static_cast<float>(wide.spread + 2 * kAngleSlack));
  } else if (spread >= kPiD - 1e-3 || between > kPiD - 1e-3) {
    // Between opposite axes there is no way to turn.
    out.spread = kPi;
  } else {
    out.axis = turned(wide.axis, narrow.axis, spread - kAngleSlack - wide.spread, between);
    out.spread = static_cast<float>(spread);
  }
  return out;
}

float emission_measure(const LightBound& bound) {
  const double o = bound.spread, w = std::min(kPiD, o + bound.reach);
  return static_cast<float>(
      2 * kPiD * (1 - std::cos(o)) +
      kPiD / 2 * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o)));
}

}  // namespace lumirank::emitters
