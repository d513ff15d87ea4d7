// The area that each surface light stands for, by which clamping bounds it.
#pragma once

#include "transport/lights/virtual_lights.h"

namespace lumirank::transport {

// Which neighbor's distance says how dense lights lie.
inline constexpr int kAreaNeighbor = 10;

// Fills `area` of the surface lights: a disc that holds ten lights has a tenth of it for each. Each half is
// measured by itself, for clamping would otherwise couple the two; a light of it stands for as much less as
// there are more lights in both. Lights of the own particle do not count (neighbor_distance.h): one that is
// caught in fur would otherwise measure its own ten lights, and clamping would let everything through.
void measure_areas(VirtualLights& lights, float scene_radius);

}  // namespace lumirank::transport
