// The part of a flight through a medium along which lamps are looked for by themselves, besides where the
// path happens to collide: a small lamp in fog shines as 1/d² on few places of a ray, which collisions seldom
// are.
//
// Densities of collisions are needed for weights alone. Of a homogeneous medium they are known; of a grid
// they are supposed: as if its extinction were the middle of its bounds, cell by cell. Any supposition is
// sound as long as both techniques are weighted by the same, since weights of one place then add up to one.
#pragma once

#include "base/equiangular.h"
#include "emitters/light_extents.h"
#include "media/medium.h"

namespace lumirank::pathtrace {

class LitStretch {
 public:
  LitStretch() = default;  // empty
  // Of a flight along unit `direction` for `distance` (may be infinite). `share`: the probability with which
  // sample() is called, a part of its density. `u` in [0, 1) draws chosen_for().
  LitStretch(const media::Medium& medium, Vec3f origin, Vec3f direction, float distance, float share,
             float u);

  bool empty() const { return !(length_ > 0); }
  bool covers(float t) const { return !empty() && t >= begin_ && t <= begin_ + length_; }
  // The place for which a lamp is to be drawn. A lamp that is bright there is likely to matter; another place
  // in every flight, so that each lamp along the way is near it in some.
  const emitters::LitPoint& chosen_for() const { return chosen_for_; }

  // False where every place within `lamps` is so far away that sample() would not find it worthwhile.
  bool near(const Bounds3f& lamps) const;
  // A distance along the flight for light from a place; its density is 0 where all of the stretch is about as
  // far from the lamp, and collisions do as well for half of the price.
  RayPlace sample(Vec3f lamp, float u) const;
  float pdf(Vec3f lamp, float t) const;

  // Per length, of a path's first collision being there, for each channel; `extinction`: the medium's there.
  Rgb collision_density(float t, Rgb extinction) const;

 private:
  bool worthwhile(Vec3f lamp) const;

  const media::Medium* medium_ = nullptr;
  Vec3f origin_, direction_;
  float begin_ = 0, length_ = 0, share_ = 1;
  emitters::LitPoint chosen_for_{};
};

}  // namespace lumirank::pathtrace
