// Pilot of light paths (pathtrace/light_tracer.h): how many of them, beside each eye path, leave the least
// noise for the time. Light paths tell by themselves how rarely eye paths find what they carry, which no
// affordable number of eye paths tells.
#pragma once

#include "base/sinks.h"
#include "methods/common/timed_choices.h"
#include "pathtrace/path_tracer.h"
#include "world/view.h"
#include "world/world.h"

namespace lumirank::pipeline {

struct LightPathPilot {
  double light_paths = 0;  // for each eye path; 0: none are worth their time
  bool aim = false;        // half of them at pathtrace::LightTargets
  double variance = 1;     // with them, over that of as many eye paths alone
  double seconds = 1;      // the same
  double left = 1;         // error of the denoised picture over that without them, in the same time
  // Light that light paths show, over what is usual where they do, in the mean over the picture; without the
  // brightest of them: one path decides nothing.
  double shown = 0;
};

// The same for every size and window of the film. `time`: seconds that the whole picture may take, 0: any.
// None if a quarter of that is not enough to know, or if it was cancelled.
LightPathPilot pilot_light_paths(const world::World& world, const world::View& view, std::uint64_t seed,
                                 pathtrace::Paths paths, double time, const Sinks& sinks);

// Which light paths a timed run has, as a choice: frames of a shot repeat it, so that no caustic comes and
// goes. What is given is the pilot's, and stays if there was no earlier run. `of`: whose they are.
void choose_light_paths(methods::TimedChoices& choices, const char* of, double& light_paths, bool& aim);

}  // namespace lumirank::pipeline
