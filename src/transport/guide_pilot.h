// Pilot paths that learn where particles should start to reach what the receivers see.
#pragma once

#include <cstdint>

#include "transport/emission_guide.h"
#include "transport/emitter_choice.h"
#include "transport/receivers.h"
#include "transport/virtual_lights.h"
#include "world/world.h"

namespace lumirank::transport {

// For settings.receivers, which must be given. Deterministic in the seed. About 50,000 paths, a few
// hundredths of a second each ten thousand.
EmissionGuide learn_guide(const world::World& world, const EmitterChoice& choice,
                          const LightSettings& settings, int deepest);

}  // namespace lumirank::transport
