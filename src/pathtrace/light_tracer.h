// Light tracing: paths that begin on emitters, and show the eye what they light (Arvo 1986; Dutré, Lafortune
// and Willems 1993). They find at once what eye paths meet by chance: light that leaves its emitter through
// glass, by a mirror, from under a shade. Both carry, together, all paths whose vertex next to the eye is
// seen directly and is not specular; but direct light from emitters that light sampling finds from there,
// which it does best. Behind mirrors and glass light paths are merged with eye paths (vertex_merging.h),
// where the density of the eye's coming is one over the area within which they are. Within a medium that
// scatters, each flight shows one place of it, made to collide there (media/forced_collision.h), besides
// where the path itself collides and turns.
//
// A path counts in every way in which it is found, by weights that sum to one: the balance heuristic (Veach
// 1997, section 9.2), with densities as if what scatters between the vertex next to the emitter and the one
// next to the eye did so alike both ways. Then only these two matter, and no vertex between. The weights
// depend on the path alone, so the mean is right whatever really scatters there.
#pragma once

#include <vector>

#include "media/tracking.h"
#include "pathtrace/emission_sampler.h"
#include "pathtrace/path_tracer.h"
#include "world/camera.h"
#include "world/emitter_media.h"

namespace lumirank::pathtrace {

class LightTracer {
 public:
  // Where on the film light is looked for.
  struct Window {
    Vec2f min, max;
    bool holds(Vec2f film) const {
      return film.x >= min.x && film.y >= min.y && film.x <= max.x && film.y <= max.y;
    }
  };
  // `light_paths` of them for one eye path in each pixel. `eye_medium`: around the camera. Must outlive it:
  // the world, the camera, the starts.
  LightTracer(const world::World& world, const world::Camera& camera, const EmissionSampler& starts,
              const Window& window, const PathSettings& settings, double light_paths, int eye_medium);

  // What a path adds to a picture whose pixels are means of eye paths.
  struct Splat {
    Vec2f film;
    Rgb value;
    bool direct;
    float ratio;  // density of light paths over that of eye paths
  };
  // What it adds where it is merged with the eye path of a pixel.
  struct Merged {
    std::uint32_t pixel;
    Rgb value;
    bool direct;
    float ratio;
  };
  struct Found {
    std::vector<Splat> splats;
    std::vector<Merged> merged;
    // Reused.
    std::vector<const MergePoint*> near;
    std::vector<geometry::Hit> crossed;
  };
  // Returns how many rays that took. `points`: of one eye path from each pixel.
  int trace(SampleStream random, std::uint64_t key, const MergePoints& points, Found& found) const;

 private:
  struct Flight;
  enum class Way { arrived, scattered, ended };
  void begin_in_medium(const EmissionSampler::Start& start, Flight& flight) const;
  Way fly(Flight& flight, float distance) const;
  bool scatter_in_medium(const EmissionSampler::Start& start, Flight& flight) const;
  bool leave_first(const EmissionSampler::Start& start, const emitters::LitPoint& at, Vec3f wi, float turned,
                   Flight& flight) const;
  bool leave_first(const EmissionSampler::Start& start, const world::SurfaceHit& hit,
                   const scatter::BsdfSample& next, Flight& flight) const;
  bool may_turn(const Flight& flight) const;
  bool survives(Flight& flight) const;
  bool show(Flight& flight, const world::SurfaceHit& hit, Found& found) const;
  void merge(Flight& flight, const world::SurfaceHit& hit, const MergePoints& points, Found& found) const;
  bool show_along(Flight& flight, float distance, Found& found) const;
  bool behind_glass(Vec3f place, const world::Camera::Seen& seen, Found& found) const;

  const world::World& world_;
  const world::Camera& camera_;
  const EmissionSampler& starts_;
  Window window_;
  PathSettings settings_;
  double light_paths_;
  world::EmitterMedia emitter_media_;
};

}  // namespace lumirank::pathtrace
