// The run report: flat, stable keys ("seconds.total", "entries.evaluated", …) as one JSON object.
#pragma once

#include <map>
#include <string>

#include "lumirank/settings.h"
#include "methods/common/timed_choices.h"
#include "pipeline/pipeline.h"

namespace lumirank::pipeline {

// What every report says of a prepared matrix and what a method did with it. `choices`: of the clock; empty
// without a budget. `cost`: of the method.
std::string make_report(const Setup& setup, const RenderSettings& settings, const methods::MethodInfo& method,
                        const methods::Estimate& estimate, const matrix::Cost& cost,
                        const methods::TimedChoices::Lists& choices, double total_seconds,
                        std::size_t lights_asked);

// Resident-set peak of this process, in bytes (0 where the system does not tell).
std::size_t peak_memory_bytes();

}  // namespace lumirank::pipeline
