// Frames of a shot one by one, with the same lights in all of them.
#pragma once

#include <memory>

#include "lumirank/lumirank.h"
#include "pipeline/shot.h"

namespace lumirank::api {

// For lights on gather samples: what moments evenly spread over the motion share, the same whatever frames
// are asked for. nullptr where frames have lights of their own.
std::shared_ptr<const pipeline::ShotLights> plan_lights_of_motion(const Scene& scene,
                                                                  const RenderSettings& settings,
                                                                  const Sinks& sinks);

// As render(), with the lights of a shot (nullptr: its own).
RenderResult render_in_shot(const Scene& scene, const RenderSettings& settings,
                            std::shared_ptr<const pipeline::ShotLights> lights, const Sinks& sinks,
                            const PreviewCallback& on_preview = {});

}  // namespace lumirank::api
