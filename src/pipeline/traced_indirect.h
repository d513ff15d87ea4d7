// Indirect light in sharp lobes by path tracing. A lobe that is narrower than the distance between virtual
// lights, or than a spherical light's cone, shows each of them as a spot or smears them; it needs few traced
// directions, and the broad lobes of the same receivers stay in the matrix, free of noise.
#pragma once

#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "base/sinks.h"
#include "transport/lights/light_reach.h"
#include "transport/rows/receivers.h"
#include "world/world.h"

namespace lumirank::pipeline {

struct TracedIndirectSettings {
  std::uint64_t seed = 1;
  float below = 0;  // lobes with a roughness below this are traced
  int paths = 16;   // per receiver with such a lobe
  int max_depth = -1;
  std::uint64_t pass = 0;  // as in transport::ReceiverSettings
  // Sharp lobes have their light from gathered receivers, be there any or not: only theirs are traced.
  bool gathered = false;
  // Unless nullptr: all lobes instead of sharp ones, and only what comes from within reach.
  const transport::LightReach* near = nullptr;
};

// Σ of values[i], one per receiver, by film sample, with the weights of the receivers' specular chains.
std::vector<Rgb> per_sample(const transport::Receivers& receivers, const std::vector<Rgb>& values);

// pathtrace::Radiance towards the eye, one per receiver. The paths are those of columns
// (docs/conventions.md): no specular vertex right after the receiver. Gathered receivers, of which nobody
// else traces the rest, have that as well; the sharp lobes of those that they were gathered for have their
// light from them.
std::vector<Rgb> trace_indirect(const world::World& world, const transport::Receivers& receivers,
                                const TracedIndirectSettings& settings, const Sinks& sinks = {});

}  // namespace lumirank::pipeline
