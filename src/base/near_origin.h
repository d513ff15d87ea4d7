// Origin that numbers should be counted from: 32 bits hold a place to 2⁻²⁴ of its distance from the origin,
// so what lies far away from it, for its size, is stated relative to an origin of its own.
#pragma once

#include "base/vec.h"

namespace lumirank {

struct Bounds3d {
  Vec3d lo{kInfinity, kInfinity, kInfinity}, hi{-kInfinity, -kInfinity, -kInfinity};

  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  void extend(Vec3d p) {
    for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], p[k]), hi[k] = std::max(hi[k], p[k]);
  }
  Vec3d center() const { return (lo + hi) * 0.5; }
  double radius() const;  // of the sphere around center() that holds the box
};

// Zero along every axis on which the box's center is at most `far` of its radii away; along the others the
// center, rounded to a multiple of the greatest power of two that is no more than the radius: so round
// numbers stay round when it is subtracted.
Vec3d near_origin(const Bounds3d& box, double far);

}  // namespace lumirank
