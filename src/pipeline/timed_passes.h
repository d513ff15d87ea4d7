// Work that is done in units (samples, paths) until its share of a time budget is spent.
#pragma once

#include <functional>

namespace lumirank::pipeline {

// Seconds since the scene began to be read; tests give one that they turn by hand.
using Clock = std::function<double()>;

struct PassLimits {
  int done = 0;        // units before
  int min_passes = 0;  // are done whatever the clock says: what a picture cannot do without
  int max_passes = 1;
  double deadline = 0;  // of the clock
  double pace = 0;      // seconds of a unit, where it is known
};

struct PassesDone {
  int done = 0;     // units in all
  double pace = 0;  // seconds of a unit; 0: unknown
  bool cancelled = false;
};

// Calls pass(units) with numbers that at most double what is done, as long as the next fits before the
// deadline at the pace so far. A pass that returns false was cancelled and ends it.
PassesDone run_passes(const PassLimits& limits, const Clock& clock, const std::function<bool(int)>& pass);

}  // namespace lumirank::pipeline
