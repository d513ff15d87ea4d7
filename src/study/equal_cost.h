// Runs of a comparison that cost the same.
#pragma once

#include "lumirank/compare.h"

namespace lumirank::study {

// Adds notes: for every method the run whose time, rays or error is nearest, in ratio, to that of the first
// method's best run. Nothing for EqualCost::none or without a run of the first method.
void note_equal_cost(const CompareSettings& settings, Comparison& comparison);

}  // namespace lumirank::study
