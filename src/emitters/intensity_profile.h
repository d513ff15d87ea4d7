// How the intensity of a point light depends on the direction.
#pragma once

#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::emitters {

class IntensityProfile {
 public:
  virtual ~IntensityProfile() = default;

  virtual Rgb intensity(Vec3f local) const = 0;  // towards a unit vector in the profile's axes
  virtual Rgb total() const = 0;                 // ∫ intensity dω

  struct Sample {
    Vec3f local;
    float pdf = 0;  // in solid angle; 0: the profile is black
  };
  virtual Sample sample(Vec2f u) const = 0;  // nearly in proportion to the intensity
  virtual float pdf(Vec3f local) const = 0;

  virtual float max_value() const = 0;  // of any channel
  // All directions that are not dark lie between these angles from +z.
  virtual float min_theta() const = 0;
  virtual float max_theta() const = 0;
};

}  // namespace lumirank::emitters
