// What the stages of a render cost in this scene on this machine, by trying each on a small part.
#pragma once

#include "render/pipeline.h"
#include "render/time_plan.h"

namespace lumirank::rendering {

// Of eye rays, traced direct light, columns, lights and film; `passed` and `pixels` are the caller's. Keeps
// in `setup` what it learnt of the light.
TimeCosts measure_costs(Setup& setup, const RenderSettings& settings, const Sinks& sinks);

}  // namespace lumirank::rendering
