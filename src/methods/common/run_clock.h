// Seconds since a method was called, by which a time budget is kept.
#pragma once

#include "base/timer.h"
#include "methods/method.h"

namespace lumirank::methods {

class RunClock {
 public:
  RunClock() = default;  // the wall clock
  explicit RunClock(const RunOptions& options) : given_(options.clock), start_(given_ ? given_() : 0) {}
  double seconds() const { return given_ ? given_() - start_ : wall_.seconds(); }

 private:
  Timer wall_;
  std::function<double()> given_;
  double start_ = 0;
};

// Share of the budget at which nothing is begun any more; what is at hand then is finished.
inline constexpr double kBudgetEnds = 0.985;
// When a run is to end, by its clock; 0: whenever it is done.
inline double deadline_of(const RunOptions& options) { return kBudgetEnds * options.time_seconds; }

}  // namespace lumirank::methods
