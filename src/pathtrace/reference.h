// The path-traced reference: passes over the film until the samples, the time or the error asked for are
// reached.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/sinks.h"
#include "image/image.h"
#include "pathtrace/path_tracer.h"
#include "world/view.h"

namespace lumirank::pathtrace {

struct ReferenceResult {
  image::Image image, direct, indirect, emission;
  int spp = 0;
  // Of the image, relative L1, from the difference of its two independent halves: Σ|A - B| / 2 / ΣI.
  double error = 0;
  bool interrupted = false;
};

// So many eye paths are near to a light path, of which one is merged with it.
inline constexpr double kMergedPixels = 2;

struct ReferenceOptions {
  std::uint64_t seed = 1;
  Paths paths = Paths::all;
  // What the image is the sum of.
  bool emission = true, direct = true, indirect = true;
  // With a bound the indirect part is only what clamped columns lack; `direct` and `emission` mean nothing
  // then.
  CarriedByColumns carried;
  // Paths from the emitters for each pixel and path from the eye, which share the work with these
  // (light_tracer.h); 0: none. Not over several instants; with media only of all paths.
  double light_paths = 0;
  bool aim_light_paths = false;  // half of them at light_targets.h's
  // Of what a pixel sees: where light paths are merged with eye paths behind mirrors and glass
  // (vertex_merging.h), which blurs by as much; 0: nowhere.
  double merged_pixels = kMergedPixels;
};

// The scene at an instant of an open shutter, and the view of it: windows are of one size and place.
struct Instant {
  std::shared_ptr<const world::World> world;
  world::View view;
};

// Paths are added in passes; the bits depend on their number alone.
class PathFilm {
 public:
  PathFilm(const world::World& world, const world::View& view, const ReferenceOptions& options);
  // Over several instants, each of which counts as much: the paths of a pixel are spread evenly over them,
  // from a start of its own, those of either half by themselves.
  PathFilm(std::vector<Instant> instants, const ReferenceOptions& options);
  ~PathFilm();

  // So many more paths per pixel. `progress` (may be empty) gets the finished fraction of the pass. False if
  // it was cancelled: result() is then still that of the passes before, and no more can be added.
  bool add(int paths, const Sinks& sinks, const std::function<void(double)>& progress = {});
  int paths() const;  // per pixel, so far
  const ReferenceResult& result() const;
  // The image of one half of the paths less that of the other: twice the noise of the image. Needs two paths.
  image::Image halves_difference() const;
  // Both without the emission that is seen straight, by mirrors or through glass.
  image::Image sent() const;
  image::Image sent_difference() const;
  // Standard deviation of the luminance of sent(), as the paths of each pixel say.
  std::vector<float> sent_deviation() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// When it is enough; without any of them after 64 paths per pixel.
struct ReferenceEnd {
  int spp = 0;
  double time = 0;   // seconds
  double error = 0;  // stated relative L1
};

// `on_pass` (may be empty) gets the image so far.
ReferenceResult path_trace(const world::World& world, const world::View& view,
                           const ReferenceOptions& options, const ReferenceEnd& end, const Sinks& sinks,
                           const std::function<void(const image::Image&)>& on_pass = {});
ReferenceResult path_trace(std::vector<Instant> instants, const ReferenceOptions& options,
                           const ReferenceEnd& end, const Sinks& sinks,
                           const std::function<void(const image::Image&)>& on_pass = {});

}  // namespace lumirank::pathtrace
