// A render in passes: each has receivers and virtual lights of its own and is a whole picture; their mean has
// neither the noise nor the floor that a set of lights has, and is denoised at the end.
#pragma once

#include "pipeline/render_run.h"

namespace lumirank::pipeline {

inline constexpr const char* kMethodOfPasses = "row-guided-sampling";

// Whether "auto" comes to that method: for a single picture of what surfaces send, unless layers, an open
// shutter or --set ask for what it has not.
bool passes_by_default(const scenedesc::SceneDesc& desc, const RenderSettings& settings);
// Whether settings ask for passes: by number, or by a method that is made for them
// unless layers or an open shutter take one picture.
bool runs_in_passes(const methods::MethodInfo& method, const RenderSettings& settings);
// Throws InputError for settings that passes cannot keep.
void check_passes(const RenderSettings& settings);

RenderResult run_in_passes(RenderTask task, const RenderSettings& settings, const Sinks& sinks,
                           const PreviewCallback& on_preview);

}  // namespace lumirank::pipeline
