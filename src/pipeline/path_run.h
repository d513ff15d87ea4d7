// One render by path tracing alone, denoised: for a scene whose light the default's rows and columns cannot
// carry well enough yet.
#pragma once

#include "pipeline/render_run.h"

namespace lumirank::pipeline {

inline constexpr const char* kByPaths = "path-tracing";
// Among the choices of a timed run: paths per pixel, if it had nothing else.
inline constexpr const char* kChoiceOfPaths = "paths";

// Whether "auto" may come to paths: unless settings ask for what only a matrix has.
bool may_be_paths(const RenderSettings& settings);
// Whether it comes to that before anything is tried: where something is filled with a medium. Smoke by
// columns is noisier than by paths in the same time, glass around a medium is black by them, and a medium
// that only absorbs is left out (docs/decisions.md).
bool paths_by_default(const scenedesc::SceneDesc& desc, const RenderSettings& settings);

// Of the task it reads world, view, why and the timer. The world must have its media.
RenderResult run_by_paths(RenderTask task, const RenderSettings& settings, const Sinks& sinks,
                          const PreviewCallback& on_preview);

}  // namespace lumirank::pipeline
