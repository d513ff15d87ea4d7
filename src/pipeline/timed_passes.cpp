#include "pipeline/timed_passes.h"

#include <algorithm>

namespace lumirank::pipeline {

PassesDone run_passes(const PassLimits& limits, const Clock& clock, const std::function<bool(int)>& pass) {
  PassesDone result{limits.done, limits.pace, false};
  double spent = 0;
  int units = 0;
  while (result.done < limits.max_passes) {
    const double left = limits.deadline - clock();
    int count = std::min(limits.max_passes - result.done, std::max(1, result.done));
    if (left <= 0)
      count = 0;
    else if (result.pace > 0)
      count = static_cast<int>(std::min<double>(count, left / result.pace));
    if (result.done < limits.min_passes) count = std::max(count, 1);
    if (count < 1) break;
    const double start = clock();
    if (!pass(count)) {
      result.cancelled = true;
      break;
    }
    spent += clock() - start, units += count;
    result.done += count;
    result.pace = spent / units;
  }
  return result;
}

}  // namespace lumirank::pipeline
