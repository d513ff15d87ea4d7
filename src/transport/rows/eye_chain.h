// From one film sample along all its specular chains to the receivers at their ends.
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"
#include "media/depth_profile.h"
#include "scatter/closure.h"
#include "scatter/closure_pool.h"
#include "transport/rows/eye_segments.h"
#include "world/world.h"

namespace lumirank::transport {

// One receiver before it is laid out; see Receivers for the fields.
struct EyeVertex {
  Vec3f position, normal, ng, wo;
  Rgb weight, albedo;
  std::uint64_t id = 0;
  std::uint32_t sample = 0, closure = 0;
  // What sort of place it is: a hash of its material and of the specular vertices (their materials and what
  // happened there) on the way from the eye.
  std::uint32_t surface = 0;
  float distance = 0;   // from the eye along the chain
  float roughness = 1;  // of its closure without delta lobes
  std::uint16_t depth = 0;
  std::int16_t medium[2] = {-1, -1};  // on the side of wo, and on the other
};

// Receivers that are shaded alike stand together: same sort of material, directly seen or mirrored, and
// facing the same way.
void sort_by_shading(std::vector<EyeVertex>::iterator begin, std::vector<EyeVertex>::iterator end);

struct FirstHit {
  Rgb albedo;
  Vec3f normal, ng, position;  // normals on the eye's side
  float distance = kInfinity;
};

struct SeenEmission {
  Rgb radiance;
  float distance = kInfinity;  // from the eye
};

struct ChainSettings {
  int max_depth = -1;
  int max_splits = 3;
  // Participating media: the one around the camera (-1: none), and into how many parts a ray's way through
  // one is cut at most; 0: they are not asked for.
  int eye_medium = -1, segments = 0;
  // Cut without chance (cut_points.h), and what comes through them known instead of estimated
  // (depth_profile.h).
  bool segments_by_depth = false;
};

// Light that passes straight through (null surfaces, cut-outs, thin glass) meets no vertex: it counts neither
// for the depth nor as a specular vertex, as in the reference.
class EyeChain {
 public:
  EyeChain(const world::World& world, const ChainSettings& settings) : world_(world), settings_(settings) {}

  // Appends the receivers of `sample` to `out`, their closures to `pool`; returns the emission that is seen.
  // `id`: of the sample, by which and by their chains receivers have theirs. `first`: what the AOVs want to
  // know, or nullptr (the albedo of glossy surfaces is not cheap). Without a pool closures are not kept;
  // instead every vertex gets its directional albedo and roughness.
  Rgb follow(const geometry::Ray& eye, std::uint64_t id, std::uint32_t sample, Rng& rng,
             std::vector<EyeVertex>& out, scatter::ClosurePool* pool, FirstHit* first);
  // The same along a ray that leaves a receiver: only straight passes are followed, and what shines is no
  // matter. Of `from` weight, id, sample and depth count.
  void follow_from(const EyeVertex& from, const geometry::Ray& ray, Rng& rng, std::vector<EyeVertex>& out,
                   scatter::ClosurePool& pool);
  // Of the emission that the last follow() returned what no mirror or glass has turned aside.
  const std::vector<SeenEmission>& straight_emission() const { return straight_emission_; }
  // Part of the eye ray that the last follow() sent along continuations that were drawn though others were
  // likelier: what ends there says little about the place that is seen.
  float unlikely() const { return unlikely_; }
  // What the last follow() passed of participating media.
  const std::vector<EyeSegment>& segments() const { return segments_; }

 private:
  struct Segment {
    geometry::Ray ray;
    Rgb weight;
    int depth;     // segments up to and including this one
    int splits;    // vertices so far at which more than one continuation was followed
    int vertices;  // surfaces met so far, straight passes included
    std::uint64_t id;
    std::uint64_t chain;  // hash of the specular vertices, straight passes excluded
    float length;         // of the segments before
    int medium;
    bool unlikely = false;
  };
  void add_receiver(const world::SurfaceHit& hit, const scatter::Closure& closure, const Segment& s,
                    std::uint32_t sample, std::vector<EyeVertex>& out, scatter::ClosurePool* pool) const;
  Rgb cross_medium(Segment& s, float length, std::uint32_t sample, Rng& rng);
  void continue_from(const world::SurfaceHit& hit, const scatter::Closure& closure, const Segment& s,
                     Rng& rng, bool straight_only);

  const world::World& world_;
  ChainSettings settings_;
  std::vector<Segment> pending_;  // reused between samples
  std::vector<EyeSegment> segments_;
  std::vector<SeenEmission> straight_emission_;
  float unlikely_ = 0;
  std::vector<float> cuts_;
  media::DepthProfile profile_;
};

}  // namespace lumirank::transport
