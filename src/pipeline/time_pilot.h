// Costs of the stages of a render in this scene on this machine, by trying each on a small part.
#pragma once

#include "pipeline/prepared.h"
#include "pipeline/time_plan.h"

namespace lumirank::pipeline {

struct TimePilot {
  TimeCosts costs;      // of eye rays, traced direct light, columns, lights and film
  SharedSurvey survey;  // of the light: takes as long for few lights as for many, and is not made again
};
TimePilot measure_costs(const SharedWorld& world, const View& view, const Recipe& recipe, const Sinks& sinks);

}  // namespace lumirank::pipeline
