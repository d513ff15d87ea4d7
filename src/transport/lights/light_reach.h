// Reach of lights: how close to each place on a surface they show themselves instead of what they stand for:
// spheres as a blur, points as spots, or as a dark rim in corners where spots are clamped away.
#pragma once

#include <optional>

#include "base/point_tree.h"
#include "transport/lights/virtual_lights.h"
#include "world/world.h"

namespace lumirank::transport {

// A receiver within the reach of a place gets the light of that place by traced paths, and nothing from
// lights that are as near (SphereRules::beyond, VirtualLights::reach). Together the two are whole: a light's
// reach and the one that it would have at any place are, over all sets of lights, distributed alike
// (Slivnyak's theorem for points that are scattered independently), so each distance is left to one of them
// on average.
// Local lights (Davidovič, Křivánek, Hašan, Slusallek and Bala 2010), divided by distance here instead of by
// lobe.
class LightReach {
 public:
  // Of spheres. `scale`: that of the radii (make_spherical); `radii`: how many of them a place reaches.
  LightReach(const VirtualLights& lights, const world::World& world, float scale, float radii);
  // Of points that have it from give_reach(), which returned `max_reach`.
  LightReach(const VirtualLights& lights, float held, float max_reach);

  // Distance; 0 if there is no surface light.
  float at(Vec3f place) const;
  float max_reach() const { return max_reach_; }  // that it can be

 private:
  // Of those, whose neighbors say how dense lights lie.
  std::size_t plant(const VirtualLights& lights, bool one_half, int neighbor);

  std::optional<PointTree> tree_;
  int neighbor_ = 0;
  bool points_ = false;
  float scale_ = 1, radii_ = 1, extent_ = 0, max_reach_ = kInfinity;
};

// Fills `reach` of points: the radius of a disc that holds `held` of the surface lights, by the area that
// each stands for (measure_areas). Returns the most that it may be, which places far from most of the light
// keep to as well: it is of so many lights that it hangs on none of them.
float give_reach(VirtualLights& lights, float held);

}  // namespace lumirank::transport
