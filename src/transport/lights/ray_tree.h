// Ray lights cut into segments, and a tree over these (Huo et al. 2016, sections 4.1 to 4.3).
#pragma once

#include <cstdint>

#include "base/sinks.h"
#include "transport/lights/ray_lights.h"

namespace lumirank::transport {

struct RayTreeSettings {
  std::uint64_t seed = 1;
  int pieces = 17;  // of a ray at most
  bool refine = true, merge = true;
};

// Each ray light becomes segments of it, whose powers are what of the ray's arrives at their origins, and
// RayLights::branch is filled: from the whole graph on, groups are divided in two by their graph until they
// are small (section 4.3 stops where all segments are alike enough; sampling divides further where it needs
// to, by place). Deterministic in the seed.
void build_ray_tree(const world::World& world, const RayTreeSettings& settings, RayLights& rays,
                    const Sinks& sinks = {});

}  // namespace lumirank::transport
