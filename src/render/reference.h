// The path-traced reference: passes over the film until the samples, the time or the error asked for are
// reached.
#pragma once

#include "base/sinks.h"
#include "film/image.h"
#include "lumirank/settings.h"
#include "render/path_tracer.h"
#include "render/pipeline.h"

namespace lumirank::rendering {

struct ReferenceResult {
  film::Image image, direct, indirect, emission;
  int spp = 0;
  // Of the image, relative L1, from the difference of its two independent halves: Σ|A - B| / 2 / ΣI.
  double error = 0;
  bool interrupted = false;
};

// Paths are added in passes; the bits depend on their number alone.
class PathFilm {
 public:
  PathFilm(const world::World& world, const View& view, const RenderSettings& settings,
           const std::string& paths, Clamped held = {});
  ~PathFilm();

  // So many more paths per pixel. `progress` (may be empty) gets the finished fraction of the pass. False if
  // it was cancelled: result() is then still that of the passes before, and no more can be added.
  bool add(int paths, const Sinks& sinks, const std::function<void(double)>& progress = {});
  const ReferenceResult& result() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// `only` and `paths` as in the settings. `on_pass` (may be empty) gets the image so far. With `held` the
// indirect part is only what clamped columns lack; `direct` and `emission` mean nothing then.
ReferenceResult path_trace(const world::World& world, const View& view, const RenderSettings& settings,
                           const ReferenceSettings& how, const Sinks& sinks,
                           const std::function<void(const film::Image&)>& on_pass = {}, Clamped held = {});

}  // namespace lumirank::rendering
