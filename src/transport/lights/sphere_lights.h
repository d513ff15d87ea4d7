// Virtual spherical lights: the radius of each surface light.
#pragma once

#include <cstddef>

#include "base/sinks.h"
#include "transport/lights/virtual_lights.h"
#include "world/world.h"

namespace lumirank::transport {

struct SphereSettings {
  // Times the distance to the 10th nearest light of other particles (Hašan et al. 2009, section 3.3, which
  // found 4 to 12); 0:
  // automatic_radius_scale().
  float radius_scale = 0;
};

// The scale that balances blur and noise for a number of surface lights: spheres hold N^(2/3) of N lights, up
// to a constant, the rate at which the squared error of a density estimate on a surface falls fastest
// (radius ∝ N^(-1/6); Silverman 1986, section 4.3). Never below 1.
float automatic_radius_scale(std::size_t surface_lights);

// Which neighbor's distance the radius follows.
inline constexpr int kSphereNeighbor = 10;
// The radius for the squared distance to that neighbor. `extent`: radius of the scene's bounding sphere.
float sphere_radius(float neighbor_distance_squared, float scale, float extent);

// Turns the surface lights into spherical ones: fills `radius` and `hidden`. The others stay points. Returns
// the scale.
float make_spherical(VirtualLights& lights, const world::World& world, const SphereSettings& settings,
                     const Sinks& sinks = {});

}  // namespace lumirank::transport
