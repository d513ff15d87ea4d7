// Completion of visibility (Wang and Holzschuch 2020, "Adaptive matrix completion for fast visibility
// computations with many lights rendering"): receivers in slices, a few columns for each of them, what these
// send unoccluded exactly, and who sees whom from few shadow rays.
//
// Slices and their columns are LightSlice's (slices/slice_lights.h); the paper cuts light trees instead, and
// completes columns as sums modulo 2 of known ones, which took four times as many rays here
// (docs/decisions.md). This uses that visibility changes along lines: completion.h.
//
// Only visibility is completed, so what shadow rays lose in thin glass on their way is not: such light counts
// whole. lightslice with the same settings has it exactly.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo visibility_completion_info();

}  // namespace lumirank::methods
