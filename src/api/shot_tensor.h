// The frames of a shot by tensor clustering, chunk by chunk (shot_chunks.h, render_tensor.h).
#pragma once

#include <vector>

#include "api/shot.h"

namespace lumirank::api {

// Writes the frames that are missing, and their chunks' tails, into the shot's folder. Where a tail that they
// are blended with is not there, the chunk before is made again for it. `result` gets how many frames are
// written, and whether it was interrupted.
void render_chunks(const Shot& shot, const std::vector<int>& missing, AnimationResult& result,
                   const Sinks& sinks);

}  // namespace lumirank::api
