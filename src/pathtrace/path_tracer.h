// Ground truth: a unidirectional path tracer with next-event estimation and multiple importance sampling
// (Veach 1997). It shares no estimator with the methods: no virtual lights, no matrix, its own random
// numbers.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "base/rgb.h"
#include "base/sample_stream.h"
#include "pathtrace/light_path_balance.h"
#include "pathtrace/vertex_merging.h"
#include "world/camera.h"
#include "world/light_sampler.h"
#include "world/world.h"

namespace lumirank::pathtrace {

// Which paths count. Columns of the matrix end in a surface or emitter hit that the receiver sees without a
// specular vertex between (docs/conventions.md), so `columns` leaves out what follows a specular vertex right
// after the receiver, and `rest` is that and nothing else: columns + rest = all.
enum class Paths { all, columns, rest };

// Light by the number of non-specular vertices between eye and emitter: none, one, more.
struct Radiance {
  Rgb emission, direct, indirect;
  int segments = 0;  // of the path, and so what it took
  Rgb total() const { return emission + direct + indirect; }
};

// What the columns of clamped virtual lights hold already. An entry is scaled down so that A·G·(π f_x)(π f_y)
// ≤ X (docs/conventions.md); where A is the same for all lights, what is left of a path depends on its first
// three vertices alone, and tracing the paths with the rest of their weight gives back what clamping took
// (Kollig and Keller 2004).
struct CarriedByColumns {
  float bound = 0;            // X / A in 1/area; 0: the columns hold nothing, all paths count in full
  bool diffuse_only = false;  // f_y of the lights is that of the diffuse lobes alone
};

struct PathSettings {
  std::uint64_t seed = 1;
  int max_depth = -1;  // Mitsuba's count; -1: unlimited
  Paths paths = Paths::all;
  CarriedByColumns carried;  // only with Paths::columns; says nothing about direct light
};

// How near to a place light must come from to count, as a distance.
struct Reach {
  std::function<float(Vec3f place)> at;
  float max = kInfinity;  // that it is anywhere
};

class PathTracer {
 public:
  PathTracer(const world::World& world, const PathSettings& settings);

  // Light paths are traced beside, and what they find as well counts the less.
  void share_with_light_paths(const LightPathBalance& balance) { beside_ = balance; }

  // Radiance arriving along `ray`, one random path: sample `sample` of the pixel whose morton2 is `place`, as
  // SampleStream::over_film spreads them. Passing straight through null
  // surfaces, cut-outs and thin glass is not a vertex and does not count for the depth. Places at which light
  // paths are to be merged with it are added to `merge_points`, if not nullptr, without their pixels.
  Radiance trace(geometry::Ray ray, std::uint32_t place, std::uint64_t sample,
                 std::vector<MergePoint>* merge_points = nullptr) const;

  // The same for several paths, each as if it were alone. They take their steps together, so that what one
  // waits for from memory comes while others are at work.
  struct Start {
    geometry::Ray ray;
    std::uint32_t place;
    std::uint64_t sample;
    std::vector<MergePoint>* merge_points = nullptr;
  };
  static constexpr std::size_t kPathsAtOnce = 16;  // more bring nothing
  void trace(std::span<const Start> starts, std::span<Radiance> found) const;

  // A non-specular vertex, and the direction in which a path leaves it.
  struct Departure {
    Vec3f position, ng;
    emitters::LitPoint from;
    scatter::BsdfSample next;
    int depth;  // segments from the eye to the vertex
    // Unless nullptr, light counts only from places that have the vertex within their reach; but with
    // Paths::all whatever follows a specular vertex counts.
    const Reach* near = nullptr;
  };
  // The indirect light that leaves the vertex, one random path with the sample's weight in it; `random` has
  // chosen the direction. `key` decides cut-outs. With Paths::all emission that a specular vertex shows is in
  // it, which is no light sample's.
  Rgb indirect_after(const Departure& departure, SampleStream random, std::uint64_t key) const;

 private:
  struct Walk;
  Walk begin(const Start& start) const;
  void finish(std::span<Walk> walks) const;
  void meet(Walk& walk) const;
  void fetch(Walk& walk) const;
  bool arrive(Walk& walk) const;
  bool leave(Walk& walk) const;
  void add_emission(Walk& walk) const;
  void sample_lights(Walk& walk, const world::SurfaceHit& hit, const scatter::Closure& closure,
                     double u_light, float connection) const;
  // The part of a path that clamped columns lack; `connection`: π f_x·G of its first two non-specular
  // vertices.
  Rgb missing(float connection, const scatter::Closure& closure, Vec3f wo, Vec3f wi) const;
  // The first vertex after a receiver: of its lobes those that the paths in question take.
  void keep_traced_lobes(const Walk& walk, const world::SurfaceHit& hit, scatter::Closure& closure) const;
  bool survives(Walk& walk) const;
  bool scatter(Walk& walk, const world::SurfaceHit& hit, scatter::Closure& closure) const;
  // How many light paths there are for the step to `next`.
  float light_paths_at(const Walk& walk, const world::SurfaceHit& hit, const scatter::Closure& closure,
                       const scatter::BsdfSample& next, float merge_area) const;

  const world::World& world_;
  const world::LightSampler& lights_;
  PathSettings settings_;
  std::optional<LightPathBalance> beside_;
};

}  // namespace lumirank::pathtrace
