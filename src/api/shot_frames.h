// The frames of a shot one by one, as they are or averaged with their neighbors. Those that are missing are
// written into the shot's folder; `result` gets how many are, and whether it was interrupted.
#pragma once

#include <vector>

#include "api/shot.h"

namespace lumirank::api {

// With the same random numbers in each, and the same lights where they can be (plan_lights_of_motion).
void render_frames(const Shot& shot, const std::vector<int>& missing, AnimationResult& result,
                   const Sinks& sinks);

// Each with random numbers of its own, averaged with its neighbors (AnimateSettings::temporal_filter), which
// are rendered for it where they are finished already, or belong to another process: a frame has the same
// bits whichever are asked for.
void render_averaged(const Shot& shot, const std::vector<int>& missing, AnimationResult& result,
                     const Sinks& sinks);

}  // namespace lumirank::api
