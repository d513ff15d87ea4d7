// Axis-aligned boxes.
#pragma once

#include "base/vec.h"

namespace lumirank {

struct Bounds3f {
  Vec3f lo{kInfinity, kInfinity, kInfinity}, hi{-kInfinity, -kInfinity, -kInfinity};

  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  void extend(Vec3f p) { lo = min(lo, p), hi = max(hi, p); }
  void extend(const Bounds3f& b) { lo = min(lo, b.lo), hi = max(hi, b.hi); }
  Vec3f diagonal() const { return hi - lo; }
  Vec3f center() const { return (lo + hi) * 0.5f; }
  // Radius of the sphere around `center()` that holds the box.
  float radius() const { return empty() ? 0.0f : 0.5f * length(diagonal()); }
};

}  // namespace lumirank
