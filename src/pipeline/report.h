// The report of a render.
#pragma once

#include "lumirank/report.h"
#include "methods/common/timed_choices.h"
#include "pipeline/develop.h"
#include "pipeline/prepared.h"

namespace lumirank::pipeline {

// Who made the picture, and from which settings.
Report begin_report(const std::string& method, const RenderSettings& settings);

// What every report says of a prepared matrix and what a method did with it. `choices`: of the clock; empty
// without a budget. `cost`: of the method.
Report make_report(const Prepared& prepared, const TracedLight& traced, const RenderSettings& settings,
                   const methods::MethodInfo& method, const methods::Estimate& estimate,
                   const matrix::Cost& cost, const methods::TimedChoices::Lists& choices);

// Resident-set peak of this process, in bytes (0 where the system does not say).
std::size_t peak_memory_bytes();

// Film samples apart from receivers: how many, what receivers they made necessary, where they have their
// light from. Nothing without them.
void add_film_numbers(std::map<std::string, double>& numbers, const Recipe& recipe,
                      const transport::Receivers& seen, const FilmFits& fits);

}  // namespace lumirank::pipeline
