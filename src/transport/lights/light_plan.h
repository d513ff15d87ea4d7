// Survey of a scene's light by pilots, before any virtual light is made, and the numbers of lights that
// follow.
#pragma once

#include <cstddef>
#include <vector>

#include "transport/lights/emitter_lights.h"
#include "transport/lights/guide_pilot.h"
#include "transport/lights/virtual_lights.h"
#include "world/emitter_choice.h"
#include "world/world.h"

namespace lumirank::transport {

// Which light is wanted, by the settings.
struct LightParts {
  bool direct = false, indirect = false;
  int deepest = -1;  // depth of a particle's light; -1: unlimited
};

// The same for any number of lights, so it can be made once for several (LightSettings::survey).
struct LightSurvey {
  LightParts parts;
  DirectNeed need;
  bool aimed = false;
  Aim aim;                   // where particles start, and where their lights are of use
  double emitter_share = 0;  // of all lights
  double level = 0;          // LightRoulette's
  double lights_per_path = 0;
};
// With receivers, `level` is that at which lights of unequal use are worth most of as many equal ones:
// (Σ use)²/Σ use² after roulette. Where the guide knows well where light comes in that is about one path for
// each few lights; where it does not, up to sixteen paths for each light are traced so that none stands for
// much more light than the others.
LightSurvey survey_lights(const world::World& world, const world::EmitterChoice& choice,
                          const LightSettings& settings);

// Of so many lights, those that emitters get for their direct light.
std::size_t emitter_sample_count(std::size_t count, const LightSurvey& survey);

struct LightPlan {
  std::size_t emitter_samples = 0;
  std::size_t paths = 0;  // of particles
};
LightPlan plan_lights(std::size_t count, const LightSurvey& survey);

// Paths and level for lights of the given uses (times the number of paths), met on `pilot_paths`, so that
// `wanted` are kept: the level is the same for any number of them. In any order.
struct RoulettePlan {
  double paths = 0, level = 0;
};
RoulettePlan plan_roulette(std::vector<double> uses, std::size_t pilot_paths, double wanted);

}  // namespace lumirank::transport
