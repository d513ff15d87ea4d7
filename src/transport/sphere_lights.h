// Virtual spherical lights: the radius of each surface light.
#pragma once

#include "base/sinks.h"
#include "transport/virtual_lights.h"
#include "world/world.h"

namespace lumirank::transport {

struct SphereSettings {
  // Times the distance to the 10th nearest light (Hašan et al. 2009, section 3.3, which found 4 to 12).
  float radius_scale = 8;
};

// Turns the surface lights into spherical ones: fills `radius` and `hidden`. The others stay points.
void make_spherical(VirtualLights& lights, const world::World& world, const SphereSettings& settings,
                    const Sinks& sinks = {});

}  // namespace lumirank::transport
