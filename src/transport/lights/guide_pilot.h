// Pilot paths that learn where particles should start to reach what the receivers see, and of how much use
// light is there.
#pragma once

#include <cstdint>

#include "transport/lights/emission_guide.h"
#include "transport/lights/light_importance.h"
#include "transport/lights/virtual_lights.h"
#include "transport/rows/receivers.h"
#include "world/emitter_choice.h"
#include "world/world.h"

namespace lumirank::transport {

struct Aim {
  EmissionGuide guide;
  LightImportance importance;
  // Irradiance times weight, in the mean over receivers: by emitters, as far as columns carry it, and by
  // surfaces.
  double direct = 0, indirect = 0;
};

// For settings.receivers, which must be given. Deterministic in the seed. About 50,000 paths, a few
// hundredths of a second each ten thousand.
Aim learn_aim(const world::World& world, const world::EmitterChoice& choice, const LightSettings& settings,
              int deepest);

}  // namespace lumirank::transport
