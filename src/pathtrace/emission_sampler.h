// Starts of light paths, from every kind of emitter.
//
// Densities are per area across the path and per solid angle. That is the same at both ends of whatever
// smooth surfaces bend on the way (the étendue is kept), so a path's density from the light can be compared
// with that from the eye without following it again.
#pragma once

#include <optional>
#include <vector>

#include "base/sample_stream.h"
#include "pathtrace/light_targets.h"
#include "world/emitter_choice.h"
#include "world/light_sampler.h"
#include "world/world.h"

namespace lumirank::pathtrace {

class EmissionSampler {
 public:
  explicit EmissionSampler(const world::World& world, LightTargets targets = {});

  bool empty() const { return choice_.empty(); }

  struct Start {
    geometry::Ray ray;
    Rgb flux;  // W over the density
    int emitter = -1;
    std::uint32_t triangle = 0;  // of an area emitter
    bool delta = false;          // eye paths meet it by light sampling alone
    bool far = false;            // it comes from without the scene
  };
  std::optional<Start> sample(SampleStream& random) const;

  // Of starts at an area emitter's triangle, or far away, that go against `direction`, with which eye paths
  // arrive there; `place`: on the triangle, or anywhere on the way. 0 for emitters that these cannot meet.
  float density(int emitter, std::uint32_t triangle, Vec3f place, Vec3f direction) const;
  // Of emitters that light sampling alone can find: starts per area across the light, where it arrives at a
  // place from `direction` after `distance`. 0 of lamps that cannot be seen, which stay with eye paths.
  float delta_density(int emitter, Vec3f place, Vec3f direction, float distance) const;
  // Radiance along a ray on which an eye path leaves the scene, each emitter's over 1 + ratio·density.
  Rgb background_left(const geometry::Ray& ray, float ratio) const;

 private:
  void aim(Start& start, const emitters::Emission& emission, float u, Vec2f where) const;
  // Densities of starts of what shines from all around, per area across: of light that arrives at a place
  // from `direction`. 0 of places to which none gets without having passed the scene by.
  float across(Vec3f place, Vec3f direction) const;
  bool passes_scene(Vec3f place, Vec3f direction) const;

  const world::World& world_;
  LightTargets targets_;
  world::EmitterChoice choice_;
  std::vector<float> probabilities_;  // of all emitters
  std::vector<int> suns_;             // with a disc
  float disc_ = 0;                    // area over which the starts of far emitters are spread
};

}  // namespace lumirank::pathtrace
