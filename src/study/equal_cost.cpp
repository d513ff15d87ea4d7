#include "study/equal_cost.h"

#include <cmath>

#include "pages/html_text.h"

namespace lumirank::study {
namespace {

double cost_of(const ComparisonRun& run, EqualCost by) {
  if (by == EqualCost::time) return run.seconds;
  return by == EqualCost::rays ? run.rays : run.error.relative_l2;
}

const char* name_of(EqualCost by) {
  if (by == EqualCost::time) return "time";
  return by == EqualCost::rays ? "rays" : "error";
}

// The run of `method` with the smallest value, or none.
template <typename Value>
const ComparisonRun* smallest(const Comparison& comparison, const std::string& method, const Value& value) {
  const ComparisonRun* best = nullptr;
  for (const ComparisonRun& run : comparison.runs)
    if (run.method == method && (!best || value(run) < value(*best))) best = &run;
  return best;
}

}  // namespace

void note_equal_cost(const CompareSettings& settings, Comparison& comparison) {
  const EqualCost by = settings.equal;
  if (by == EqualCost::none || settings.methods.empty()) return;
  const ComparisonRun* best = smallest(comparison, settings.methods.front(),
                                       [](const ComparisonRun& run) { return run.error.relative_l2; });
  if (!best) return;
  const double cost = cost_of(*best, by);
  comparison.notes.push_back(std::string("At equal ") + name_of(by) + " to " + best->label + ":");
  for (const std::string& method : settings.methods)
    if (const ComparisonRun* nearest = smallest(comparison, method, [&](const ComparisonRun& run) {
          return std::abs(std::log(cost_of(run, by) / cost));
        }))
      comparison.notes.push_back(nearest->label + ": " + pages::show_seconds(nearest->seconds) + ", " +
                                 pages::show_count(nearest->rays) + " rays, relative L2 " +
                                 pages::show_percent(nearest->error.relative_l2));
}

}  // namespace lumirank::study
