// Affine (and projective) 4×4 transforms in double precision: scene files chain many of them.
#pragma once

#include <array>
#include <optional>

#include "base/vec.h"

namespace lumirank {

struct Transform {
  // Row-major; column vectors are multiplied from the right.
  std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

  static Transform translate(double x, double y, double z);
  static Transform translate(Vec3d v) { return translate(v.x, v.y, v.z); }
  static Transform scale(double x, double y, double z);
  // Counter-clockwise about `axis` (any length but zero), in degrees.
  static Transform rotate(double x, double y, double z, double degrees);
  // Camera-to-world with the camera looking along +z, +y up and +x to the left (Mitsuba's convention).
  static Transform look_at(Vec3d origin, Vec3d target, Vec3f up);
  static Transform aimed(Vec3d origin, Vec3f direction, Vec3f up);  // direction: of any length

  friend Transform operator*(const Transform& a, const Transform& b);  // applies b first
  friend bool operator==(const Transform&, const Transform&) = default;

  // Empty if the matrix is singular.
  std::optional<Transform> inverse() const;
  double determinant3() const;  // of the linear part; negative if it mirrors
  bool is_finite() const;
  bool is_identity() const { return *this == Transform{}; }

  Vec3f point(Vec3f p) const;  // divides by w if the transform is projective
  Vec3d place(Vec3d p) const;  // the same, not rounded
  Vec3d origin() const { return place({}); }
  Vec3d axis(int k) const {  // where the k-th unit vector goes
    const auto i = static_cast<std::size_t>(k);
    return {m[i], m[4 + i], m[8 + i]};
  }
  Vec3f vector(Vec3f v) const;  // linear part only
  // A normal under *this*, given the inverse of this transform; not normalized.
  static Vec3f normal(const Transform& inverse, Vec3f n);
};

}  // namespace lumirank
