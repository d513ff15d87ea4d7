// Indirect columns: particles leave the emitters, and every surface that they meet becomes a virtual light
// (Keller 1997, "Instant radiosity", with Russian roulette in place of fixed path lengths).
#pragma once

#include <cstdint>

#include "base/random.h"
#include "transport/lights/emission_guide.h"
#include "transport/lights/light_record.h"
#include "transport/lights/light_roulette.h"
#include "transport/lights/shining_lobes.h"
#include "world/emitter_choice.h"
#include "world/world.h"

namespace lumirank::transport {

struct ParticleSettings {
  std::uint64_t seed = 1;
  Stage stage = Stage::particles;
  std::size_t paths = 1;                    // powers are divided by it
  int deepest = -1;                         // greatest depth of a light; -1: unlimited
  std::uint64_t first_id = 0;               // random numbers belong to first_id + path
  const EmissionGuide* guide = nullptr;     // not owned; nullptr: uniform
  ShiningLobes lobes = {};                  // of the lights; paths are those of all lobes
  const LightRoulette* roulette = nullptr;  // not owned; nullptr: all lights are kept
};

// What a path met, for the pilot.
struct PathTally {
  double first_flux = 0;      // that arrived at first hits
  double scattered_flux = 0;  // that all lights together send on
  std::size_t vertices = 0;   // mirrors and glass among them
};

class ParticleTracer {
 public:
  ParticleTracer(const world::World& world, const world::EmitterChoice& choice,
                 const ParticleSettings& settings)
      : world_(world), choice_(choice), settings_(settings) {
    if (settings_.guide == nullptr) settings_.guide = &uniform_;
  }
  ParticleTracer(const ParticleTracer&) = delete;

  // Path number `path` of settings.paths: its lights are appended to `batch`. A function of
  // (seed, stage, path, guide, roulette). Returns where it started.
  EmissionGuide::Start trace(std::size_t path, LightBatch& batch, PathTally* tally = nullptr) const;

 private:
  // A path, or one of those that a heavy one was split into.
  struct Branch {
    geometry::Ray ray;
    Rgb flux;
    float level;  // of flux: less is paid in the chance to survive
    int depth;    // of the next vertex
    std::uint64_t id;
    int medium = -1;  // that colors the glass which it is in; -1: none
  };
  struct Visit;
  void follow(const EmissionGuide::Start& start, std::uint64_t id, Rng& rng, LightBatch& batch,
              PathTally* tally) const;
  // One vertex of a branch: leaves its light, and pushes what goes on.
  void step(Branch branch, Visit& visit) const;
  int leave(LightRecord& light, const scatter::Closure& shining, Visit& visit) const;
  bool scatter_on(const world::SurfaceHit& hit, const scatter::Closure& closure, Vec3f incoming,
                  Branch& branch, Rng& rng) const;

  const world::World& world_;
  const world::EmitterChoice& choice_;
  ParticleSettings settings_;
  EmissionGuide uniform_;
};

// Of settings.paths, an even number that tells as much for the time: where surfaces lose next to nothing a
// path goes on and on, and of longer ones than usual fewer are enough. By a trial of a few.
std::size_t paths_worth_tracing(const world::World& world, const world::EmitterChoice& choice,
                                const ParticleSettings& settings);

}  // namespace lumirank::transport
