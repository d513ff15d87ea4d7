// Pilot paths that learn where particles should start to reach what the receivers see.
#pragma once

#include <cstdint>

#include "transport/emission_guide.h"
#include "transport/emitter_choice.h"
#include "transport/receivers.h"
#include "world/world.h"

namespace lumirank::transport {

// Deterministic in the seed. About 50,000 paths, a few hundredths of a second each ten thousand.
EmissionGuide learn_guide(const world::World& world, const EmitterChoice& choice, const Receivers& receivers,
                          std::uint64_t seed, int deepest);

}  // namespace lumirank::transport
