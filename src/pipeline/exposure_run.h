// One render with an open shutter, of worlds that are built: from their matrix to the picture and its report.
#pragma once

#include "pipeline/exposure.h"
#include "pipeline/render_run.h"

namespace lumirank::pipeline {

// `task.world` and `task.view` are not used.
RenderResult run_exposure(const std::vector<Instant>& instants, RenderTask task,
                          const RenderSettings& settings, const Sinks& sinks,
                          const PreviewCallback& on_preview);

}  // namespace lumirank::pipeline
