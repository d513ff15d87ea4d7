// The coordinates that a world is built in. 32-bit numbers and the small steps and floors of tracing suit a
// scene of ordinary size around the origin. Any other is moved there and scaled, as a whole and in one place:
// shapes, emitters and cameras with it; what is reported goes back.
#pragma once

#include "base/near_origin.h"
#include "base/rgb.h"
#include "base/transform.h"

namespace lumirank::world {

class Units {
 public:
  Units() = default;  // the file's own
  // For a scene within `box`, in the file's units. Most scenes keep theirs, and with them every bit:
  // - An axis along which the box's center is more than kFar radii away from the origin is counted from the
  //   center. The step by which rays leave a surface, 5·10⁻⁵ of its coordinates, then is at most 9 times
  //   that of the centered scene: 5·10⁻⁴ of the radius. (What was measured far away: +8 % light at 5,800
  //   radii.)
  // - A radius below 2⁻⁵ is made 1 to 2: under 0.02 that step no longer shrinks with the scene.
  // - A radius above 2²⁴ is made 2²³ to 2²⁴, so that fourth powers of lengths, with powers of lights beside
  //   them, stay within floats; but no further than keeps the radius of the smallest shape above 1: a few
  //   things far away from one another must not make all of them tiny.
  // Scales are powers of two, which keep bits.
  static constexpr double kFar = 8, kMinRadius = 0x1p-5, kMaxRadius = 0x1p24;
  explicit Units(const Bounds3d& box, double min_shape_radius = kInfinity);

  bool are_the_files() const { return scale_ == 1 && origin_ == Vec3d{}; }
  double scale() const { return scale_; }  // the world's lengths over the file's
  const Vec3d& origin() const { return origin_; }
  // From the file's places to the world's.
  Transform to_world() const;
  Transform to_world(const Transform& t) const { return are_the_files() ? t : to_world() * t; }
  Vec3f to_world(Vec3d place) const;
  // Radiance and irradiance stay as they are, so what grows with area does so here too: watts, W/sr.
  // Infinite where 32 bits cannot hold it.
  Rgb power_to_world(Rgb value) const;

  Vec3d place_in_file(Vec3f place) const;
  float length_in_file(float length) const;
  Rgb power_in_file(Rgb value) const;

 private:
  Vec3d origin_;
  double scale_ = 1;
};

}  // namespace lumirank::world
