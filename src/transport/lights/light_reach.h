// Reach of spherical lights: how close to each place on a surface they blur what they show.
#pragma once

#include <optional>

#include "base/point_tree.h"
#include "transport/lights/virtual_lights.h"
#include "world/world.h"

namespace lumirank::transport {

// A receiver within the reach of a place gets the light of that place by traced paths, and nothing from
// spherical lights that are as near (SphereRules::beyond). Together the two are whole: a light's radius and
// the one that it would have at any place are, over all sets of lights, distributed alike (Slivnyak's theorem
// for points that are scattered independently), so each distance is left to one of them on average.
class LightReach {
 public:
  // `scale`: that of the radii (make_spherical); `radii`: how many of them a place reaches.
  LightReach(const VirtualLights& lights, const world::World& world, float scale, float radii);

  // Distance; 0 if there is no spherical light.
  float at(Vec3f place) const;

 private:
  std::optional<PointTree> tree_;
  int neighbor_ = 0;
  float scale_, radii_, extent_;
};

}  // namespace lumirank::transport
