// Which emitter to sample, and the density with which any hit on one would have been sampled. For the path
// tracer and the directly traced receivers; the matrix does not use it.
#pragma once

#include <vector>

#include "base/distribution.h"
#include "emitters/emitter.h"
#include "world/world.h"

namespace lumirank::rendering {

class LightSampler {
 public:
  explicit LightSampler(const world::World& world);

  bool empty() const { return by_power_.total() <= 0; }

  // One sample of the light arriving at `point`; `pdf` includes the choice of the emitter (a probability for
  // delta emitters).
  struct Sample {
    emitters::DirectSample direct;
    int emitter = -1;
    float pdf = 0;
  };
  Sample sample(Vec3f point, float u_emitter, float u1, Vec2f u2) const;

  // Solid-angle density of sample() for a surface hit at `distance` along unit `direction`.
  float pdf_hit(const world::SurfaceHit& hit, Vec3f direction, float distance) const;
  // The same for a ray that leaves the scene.
  float pdf_background(Vec3f direction) const;

 private:
  const world::World& world_;
  Distribution1D by_power_;
  std::vector<std::vector<std::int32_t>>
      triangle_of_;  // per emitter: mesh triangle → index of the emitter's triangle, or -1
};

// Light through whatever lets it pass straight: the fraction that arrives over the open segment from `from`
// (a surface point with geometric normal `ng`) towards `direction` for `distance` (may be infinite).
Rgb visible_fraction(const world::World& world, Vec3f from, Vec3f ng, Vec3f direction, float distance,
                     std::uint64_t key);

}  // namespace lumirank::rendering
