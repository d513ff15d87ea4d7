// How many lights of which sort, fixed by pilots before any is made.
#pragma once

#include <cstddef>

#include "transport/emitter_choice.h"
#include "transport/guide_pilot.h"
#include "transport/virtual_lights.h"
#include "world/world.h"

namespace lumirank::transport {

struct LightPlan {
  std::size_t emitter_samples = 0;
  std::size_t paths = 0;  // of particles
  Aim aim;                // where they start, and where their lights are of use
  double level = 0;       // LightRoulette's
};

struct LightParts {
  bool direct, indirect;
  int deepest;  // depth of a particle's light; -1: unlimited
};

// With receivers, the number of paths is that from which on lights of unequal use are worth most of
// settings.count equal ones: (Σ use)²/Σ use² after roulette. Where the guide knows well where light comes in
// that is about one path for each few lights; where it does not, up to sixteen paths for each light are
// traced so that none stands for much more light than the others.
LightPlan plan_lights(const world::World& world, const EmitterChoice& choice, const LightSettings& settings,
                      LightParts parts);

// Paths and level for lights of the given uses (times the number of paths), met on `pilot_paths`, so that
// `wanted` are kept. In any order.
struct RoulettePlan {
  double paths = 0, level = 0;
};
RoulettePlan plan_roulette(std::vector<double> uses, std::size_t pilot_paths, double wanted);

}  // namespace lumirank::transport
