// Gather samples: places on the surfaces of a scene, tied to their triangles, so that they are the same
// places at every moment of it, wherever they have moved (Hašan et al. 2008, section 5). Virtual lights that
// stand on them are the same lights in every frame of a shot.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transport/lights/emitter_lights.h"
#include "transport/lights/light_importance.h"
#include "world/world.h"

namespace lumirank::transport {

struct LightSurvey;

struct GatherSample {
  std::uint64_t id = 0;
  std::uint32_t shape = 0;      // index into GatherSamples::shapes
  std::uint32_t primitive = 0;  // triangle, or segment of fibers
  Vec2f at;                     // barycentric; fibers: how far along, and a number in [0, 1) for across
  float part = 0;               // of the primitive's area that the sample stands for
};

struct GatherSamples {
  struct Shape {
    std::uint64_t id = 0;  // World::placement_ids()
    std::size_t primitives = 0;
  };
  std::vector<Shape> shapes;
  std::vector<GatherSample> samples;  // in the order of their shapes and primitives
};

// A moment of the scene at which it was asked where light is of use.
struct GatherMoment {
  const world::World* world = nullptr;
  const LightImportance* importance = nullptr;  // nullptr: the same everywhere
};

// About `count` samples, denser where light that leaves the surface is of use at any of the moments (one at
// least). Whatever has area at one of them gets samples; what is in none of their worlds gets none.
GatherSamples place_gather_samples(std::span<const GatherMoment> moments, std::uint64_t seed,
                                   std::size_t count);

// What all moments of a scene share, so that their lights are the same lights.
struct GatherPlan {
  GatherSamples samples;
  EmitterCounts emitters;  // none where direct light is not wanted
  std::size_t photons = 0;
};

}  // namespace lumirank::transport
