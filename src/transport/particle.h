// Indirect columns: particles leave the emitters, and every surface that they meet becomes a virtual light
// (Keller 1997, "Instant radiosity", with Russian roulette in place of fixed path lengths).
#pragma once

#include <cstdint>

#include "base/random.h"
#include "transport/emitter_choice.h"
#include "transport/light_record.h"
#include "world/world.h"

namespace lumirank::transport {

struct ParticleSettings {
  std::uint64_t seed = 1;
  Stage stage = Stage::particles;
  std::size_t paths = 1;  // powers are divided by it
  int deepest = -1;       // greatest depth of a light; -1: unlimited
};

// What a path met, for the pilot.
struct PathTally {
  double first_flux = 0;      // that arrived at first hits
  double scattered_flux = 0;  // that all lights together send on
};

class ParticleTracer {
 public:
  ParticleTracer(const world::World& world, const EmitterChoice& choice, const ParticleSettings& settings)
      : world_(world), choice_(choice), settings_(settings) {}

  // Path number `path` of settings.paths: its lights are appended to `batch`. A function of (seed, stage,
  // path).
  void trace(std::size_t path, LightBatch& batch, PathTally* tally = nullptr) const;

 private:
  const world::World& world_;
  const EmitterChoice& choice_;
  ParticleSettings settings_;
};

}  // namespace lumirank::transport
