// Number of slices, also under a time budget.
#pragma once

#include "methods/common/run_clock.h"
#include "methods/common/slices/slice_lights.h"
#include "methods/method.h"

namespace lumirank::methods {

// The settings with `slice_rows` fixed. Under --time, by the clock of the run, as many slices (the timed
// choice "slices"), and as many of the columns, as should fit by the time of `row_seconds`, or where that is
// 0 of three trial rows: a slice costs its row and about as much again for its clusters, and columns cost
// what their entries would in a row.
SliceLightSettings with_slice_rows(SliceLightSettings settings, const matrix::LightingMatrix& matrix,
                                   const RunOptions& options, const RunClock& clock, double row_seconds);

}  // namespace lumirank::methods
