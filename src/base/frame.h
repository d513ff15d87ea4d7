// Orthonormal frames; local z is the normal.
#pragma once

#include "base/vec.h"

namespace lumirank {

struct Frame {
  Vec3f s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

  Vec3f to_local(Vec3f v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3f to_world(Vec3f v) const { return s * v.x + t * v.y + n * v.z; }

  // Any frame around a unit normal, without branches near the poles (Duff et al. 2017).
  static Frame from_normal(Vec3f n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }

  // The frame around `n` whose s follows `tangent` as closely as orthogonality allows.
  static Frame from_normal_tangent(Vec3f n, Vec3f tangent) {
    const Vec3f s = tangent - n * dot(n, tangent);
    const float len2 = length_squared(s);
    if (!(len2 > 1e-20f)) return from_normal(n);
    const Vec3f unit = s / std::sqrt(len2);
    return {unit, cross(n, unit), n};
  }
};

}  // namespace lumirank
