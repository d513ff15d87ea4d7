// Ground truth where there are participating media: a unidirectional path tracer that also scatters within
// them, with next-event estimation and multiple importance sampling. Like PathTracer it shares no estimator
// with the methods.
//
// Distances are drawn for one channel of each path and weighted over all three (media/tracking.h). Light of
// lamps is also sampled along each flight (lit_stretch.h). The ways to find it are weighted against each
// other without the transmittance towards the lamp: all estimate the same, so leaving it out keeps the
// weights a partition of one.
#pragma once

#include <cstdint>
#include <optional>

#include "media/tracking.h"
#include "pathtrace/path_tracer.h"
#include "world/straight_path.h"

namespace lumirank::pathtrace {

class LitStretch;

class VolumePathTracer {
 public:
  // `eye_medium`: around the camera, -1: empty space. max_depth as in PathSettings; scattering in a medium is
  // a vertex.
  VolumePathTracer(const world::World& world, std::uint64_t seed, int max_depth, int eye_medium);

  // As PathTracer's.
  void share_with_light_paths(const LightPathBalance& balance) { beside_ = balance; }

  // As PathTracer::trace; scattering in a medium is a non-specular vertex, and what a medium emits is
  // emission. Light paths are merged on surfaces alone.
  Radiance trace(geometry::Ray ray, std::uint32_t place, std::uint64_t sample,
                 std::vector<MergePoint>* merge_points = nullptr) const;
  void trace(std::span<const PathTracer::Start> starts, std::span<Radiance> found) const {
    for (std::size_t k = 0; k < starts.size(); ++k)
      found[k] = trace(starts[k].ray, starts[k].place, starts[k].sample, starts[k].merge_points);
  }

 private:
  struct Vertex;
  struct Walk;
  enum class Flight { arrived, scattered, ended };
  Flight fly(Walk& walk, float distance) const;
  void sample_lamp_along(Walk& walk, const media::Medium& medium, const LitStretch& lit) const;
  bool scatter_in_medium(Walk& walk, const media::Coefficients& at) const;
  void add_emission(Walk& walk, const world::SurfaceHit* hit) const;
  bool scatter_on_surface(Walk& walk, const world::SurfaceHit& hit) const;
  bool survives(Walk& walk) const;
  float left_of_sampled(const Walk& walk, Vec3f place, const world::LightSampler::Sample& light,
                        float turned) const;

  const world::World& world_;
  const world::LightSampler& lights_;
  std::uint64_t seed_;
  int max_depth_, eye_medium_;
  std::optional<LightPathBalance> beside_;
};

}  // namespace lumirank::pathtrace
