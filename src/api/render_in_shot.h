// Frames of a shot one by one, with the same lights in all of them.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/timer.h"
#include "lumirank/lumirank.h"
#include "pipeline/shot.h"
#include "pipeline/shot_filter.h"

namespace lumirank::api {

// For lights on gather samples: what moments evenly spread over the motion share, the same whatever frames
// are asked for. nullptr where frames have lights of their own.
std::shared_ptr<const pipeline::ShotLights> plan_lights_of_motion(const Scene& scene,
                                                                  const RenderSettings& settings,
                                                                  const Sinks& sinks);

// What a frame has from others of its shot.
struct InShot {
  std::shared_ptr<const pipeline::ShotLights> lights = nullptr;  // nullptr: its own
  // If given: the world of a frame before (nullptr: none), whose structures are refitted and which nobody
  // else may trace; becomes this frame's. Not with an open shutter.
  std::shared_ptr<const world::World>* refit = nullptr;
  // Of another moment, with which its world shares what does not change, and whose units it has.
  std::shared_ptr<const world::World> before = nullptr;
  std::string why = {};  // it is this method; empty: as the settings say
  // As a longer look at the shot found that it is best, if the settings leave it open.
  enum class Kind { open, passes, paths };
  Kind kind = Kind::open;
  bool may_be_paths = false;              // where these have less noise (paths_beside.h)
  double part_of_usual = 1;               // RenderTask
  pipeline::ShotFrame* filmed = nullptr;  // if given: becomes what its neighbors need of it (shot_filter.h)
  // Built for it already, if given; `timer` began before that.
  std::shared_ptr<const world::World> world = nullptr;
  std::optional<Timer> timer = {};
};

// As render(), of a frame of a shot.
RenderResult render_by_choice(const Scene& scene, const RenderSettings& settings, InShot shot,
                              const Sinks& sinks, const PreviewCallback& on_preview = {});

// The same by the method that the settings name, "auto" being that of chosen_method().
RenderResult render_in_shot(const Scene& scene, const RenderSettings& settings, const InShot& shot,
                            const Sinks& sinks, const PreviewCallback& on_preview = {});

}  // namespace lumirank::api
