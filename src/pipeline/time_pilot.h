// What the stages of a render cost in this scene on this machine, by trying each on a small part.
#pragma once

#include "pipeline/pipeline.h"
#include "pipeline/time_plan.h"

namespace lumirank::pipeline {

// Of eye rays, traced direct light, columns, lights and film; `passed` and `pixels` are the caller's. Keeps
// in `setup` what it learnt of the light.
TimeCosts measure_costs(Setup& setup, const RenderSettings& settings, const Sinks& sinks);

}  // namespace lumirank::pipeline
