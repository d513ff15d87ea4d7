// A coarse estimate of every row, quickly: what rows have under a time budget until a method's own estimate
// of them is done, so that no part of a picture is ever without one.
//
// Some columns, drawn by their power and by what a few rows get of them, are read for all rows: unbiased.
// Rows go from coarse to fine over the picture; where not even one column can be afforded for all of them,
// those that were not reached take the estimate of the nearest that was. A row that all n columns left dark
// is no dark row for sure: by the rule of succession one more column would reach it with probability
// 1/(n + 2), and that share of the nearest lit row's sum it gets.
#pragma once

#include <span>

#include "methods/common/run_clock.h"
#include "methods/method.h"

namespace lumirank::methods {

struct CoarsePicture {
  std::size_t columns = 0;     // draws; 0: cancelled, and there is no picture
  double entry_seconds = 0;    // of one entry, all threads at work; 0 where no clock was asked
  bool all_rows_read = false;  // otherwise some took the estimate of others
};

// Writes all sums. Takes about a twentieth of the budget, up to a fifth where that buys few columns, and one
// column each for a few rows in any case. Records the choices "coarse_rows", "coarse_columns" and "units".
CoarsePicture make_coarse_picture(const matrix::LightingMatrix& matrix, const RunOptions& options,
                                  const RunClock& clock, std::span<Rgb> sums);

}  // namespace lumirank::methods
