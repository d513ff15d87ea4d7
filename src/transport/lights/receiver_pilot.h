// A pilot from the receivers' side: rays to what they see, and from there to the emitters. Light that few of
// the emitters' own paths would find, because it comes in by a small window, is found at once.
#pragma once

#include <cstdint>
#include <vector>

#include "transport/lights/emission_guide.h"
#include "transport/lights/light_importance.h"
#include "transport/rows/receivers.h"
#include "world/emitter_choice.h"
#include "world/world.h"

namespace lumirank::transport {

struct ReceiverPilot {
  // Where paths that light what receivers see would start. Densities are not known: they are those of
  // importance itself, and `value` is what each stands for.
  std::vector<EmissionGuide::Observation> starts;
  // What receivers see and where they are themselves; values are left to the caller.
  std::vector<LightImportance::Site> places;
  // Irradiance by emitters in the mean over receivers, times their weight and the part of their reflectance
  // whose direct light columns carry.
  double direct = 0;
};

// `traced_below`: lobes with a roughness below it get their direct light elsewhere. Deterministic in the
// seed.
ReceiverPilot run_receiver_pilot(const world::World& world, const world::EmitterChoice& choice,
                                 const Receivers& receivers, std::uint64_t seed, float traced_below);

}  // namespace lumirank::transport
