// Sampling of lights, and the density with which any hit on one would have been sampled. For the path tracer
// and the directly traced receivers; the matrix does not use it.
#pragma once

#include <vector>

#include "base/distribution.h"
#include "emitters/emitter.h"
#include "emitters/light_tree.h"
#include "scatter/closure.h"
#include "world/world.h"

namespace lumirank::world {

// What light sampling needs to know of a surface that scatters by `closure` towards wo: the side from which
// light matters, or both.
emitters::LitPoint lit_point(Vec3f position, const scatter::Closure& closure, Vec3f wo);

// Triangles of area lights, points and spots are leaves of one light tree; what is infinitely far is chosen
// by its irradiance. Neither group gets less than a quarter where both shine.
class LightSampler {
 public:
  explicit LightSampler(const World& world);

  // One sample of the light arriving at a point; `pdf` includes the choice of the light (a probability for
  // delta emitters). pdf 0: nothing found.
  struct Sample {
    emitters::DirectSample direct;
    int emitter = -1;
    float pdf = 0;
  };
  Sample sample(const emitters::LitPoint& at, double u_light, Vec2f u) const;

  // Solid-angle density of sample() for a surface hit at `distance` along unit `direction` from `at`.
  float pdf_hit(const emitters::LitPoint& at, const SurfaceHit& hit, Vec3f direction, float distance) const;
  // The same for a ray that leaves the scene.
  float pdf_background(const emitters::LitPoint& at, Vec3f direction) const;

 private:
  float near_share(const emitters::LitPoint& at) const;

  const World& world_;
  struct Leaf {
    int emitter;
    std::uint32_t triangle;  // of area emitters
  };
  std::vector<Leaf> leaves_;
  std::vector<std::uint32_t> first_leaf_;  // per emitter; its triangles follow each other
  emitters::LightTree tree_;
  std::vector<int> far_;
  Distribution1D far_choice_;
  float near_share_ = 1;
};

// Light through whatever lets it pass straight: the fraction that arrives over the open segment from `from`
// (a surface point with geometric normal `ng`) towards `direction` for `distance` (may be infinite).
Rgb visible_fraction(const World& world, Vec3f from, Vec3f ng, Vec3f direction, float distance,
                     std::uint64_t key);

}  // namespace lumirank::world
