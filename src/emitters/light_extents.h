// Bounds of eight groups of lights made ready for many questions: spheres instead of boxes, cosines instead
// of angles, side by side so that one vector instruction serves all.
#pragma once

#include "emitters/light_bound.h"

namespace lumirank::emitters {

class LightExtents {
 public:
  static constexpr int kCount = 8;

  // All slots without intensity.
  LightExtents();
  void set(int slot, const LightBound& bound);

  // Of each slot, the irradiance that arrives at the point as if all its light came from the sphere's center,
  // with the most favorable cosines that the sphere and the cone of normals leave possible. 0 only where no
  // light can arrive; rounding is on the safe side: what is seen by a grazing 10⁻³ stays possible.
  void importance(const LitPoint& at, float out[kCount]) const;

 private:
  // The compilers' vector extension: eight floats in the widest registers that the build has.
  typedef float Lane __attribute__((vector_size(4 * kCount)));
  struct Angle {
    Lane cosine, sine;
  };
  static Lane sqrt(Lane a);
  static Angle angle(Lane cosine);
  static Angle less(Angle a, Angle b);

  Lane center_x_{}, center_y_{}, center_z_{}, radius2_{};
  Lane axis_x_{}, axis_y_{}, axis_z_{};
  Angle spread_{};
  Lane min_cosine_{};  // of the angle beyond all normals
  Lane intensity_{};
};

}  // namespace lumirank::emitters
