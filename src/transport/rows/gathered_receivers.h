// Receivers one scattering further from the eye: the places whose light comes in sharp lobes.
#pragma once

#include <cstdint>

#include "base/sinks.h"
#include "transport/rows/receivers.h"
#include "world/world.h"

namespace lumirank::transport {

struct GatherSettings {
  std::uint64_t seed = 1;
  std::uint64_t pass = 0;  // as in ReceiverSettings
  float below = 0.3f;      // lobes of a roughness below this
  int max_depth = -1;
};

// `rows`, and behind them (Receivers::gathered) what stands for the indirect light in their sharp lobes: for
// each that has such lobes one direction of them is drawn and followed to what it meets, which becomes a
// receiver of the same film sample with f·cosine / density in its weight. A light lobe is followed in
// proportion to what it weighs. Emission that it meets is direct light of `rows`, and not in what these
// receivers send; specular vertices that it meets are passed by, as their paths are the rest's and no
// columns' (docs/conventions.md).
// (Final gathering: H. W. Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001; one direction at a
// time.)
Receivers with_gathered(const world::World& world, Receivers rows, const GatherSettings& settings,
                        const Sinks& sinks);

}  // namespace lumirank::transport
