// Ground truth: a unidirectional path tracer with next-event estimation and multiple importance sampling
// (Veach 1997). It shares no estimator with the methods: no virtual lights, no matrix, its own random
// numbers.
#pragma once

#include <array>
#include <cstdint>

#include "base/rgb.h"
#include "render/light_sampler.h"
#include "world/camera.h"
#include "world/world.h"

namespace lumirank::rendering {

// Which paths count. Columns of the matrix end in a surface or emitter hit that the receiver sees without a
// specular vertex between (docs/conventions.md), so `columns` leaves out what follows a specular vertex right
// after the receiver, and `rest` is that and nothing else: columns + rest = all.
enum class Paths { all, columns, rest };

// Light by the number of non-specular vertices between eye and emitter: none, one, more.
struct Radiance {
  Rgb emission, direct, indirect;
  Rgb total() const { return emission + direct + indirect; }
};

struct PathSettings {
  std::uint64_t seed = 1;
  int max_depth = -1;  // Mitsuba's count; -1: unlimited
  Paths paths = Paths::all;
};

class PathTracer {
 public:
  PathTracer(const world::World& world, const PathSettings& settings);

  // Radiance arriving along `ray`, one random path keyed by (pixel, sample). Passing straight through null
  // surfaces, cut-outs and thin glass is not a vertex and does not count for the depth.
  Radiance trace(geometry::Ray ray, std::uint64_t pixel, std::uint64_t sample) const;

 private:
  struct Walk;
  void add_emission(Walk& walk, const world::SurfaceHit* hit) const;
  void sample_lights(Walk& walk, const world::SurfaceHit& hit, const scatter::Closure& closure,
                     double u_light) const;
  bool scatter(Walk& walk, const world::SurfaceHit& hit, scatter::Closure& closure) const;

  const world::World& world_;
  LightSampler lights_;
  PathSettings settings_;
};

}  // namespace lumirank::rendering
