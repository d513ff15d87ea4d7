#include "pages/summary.h"

#include <algorithm>

namespace lumirank::pages {

double ComparisonGroup::mean(const std::function<double(const ComparisonRun&)>& value) const {
  double sum = 0;
  for (const ComparisonRun* run : runs) sum += value(*run);
  return sum / static_cast<double>(runs.size());
}

double ComparisonGroup::lowest(const std::function<double(const ComparisonRun&)>& value) const {
  double min_value = value(first());
  for (const ComparisonRun* run : runs) min_value = std::min(min_value, value(*run));
  return min_value;
}

double ComparisonGroup::highest(const std::function<double(const ComparisonRun&)>& value) const {
  double max_value = value(first());
  for (const ComparisonRun* run : runs) max_value = std::max(max_value, value(*run));
  return max_value;
}

ComparisonSummary summarize(const Comparison& results) {
  ComparisonSummary summary;
  for (const ComparisonRun& run : results.runs) {
    auto series = std::find(summary.series.begin(), summary.series.end(), run.series);
    if (series == summary.series.end()) series = summary.series.insert(series, run.series);
    const auto number = static_cast<std::size_t>(series - summary.series.begin());
    auto group = std::find_if(summary.groups.begin(), summary.groups.end(), [&](const ComparisonGroup& g) {
      return g.series == number && g.first().label == run.label;
    });
    if (group == summary.groups.end()) group = summary.groups.insert(group, ComparisonGroup{{}, number});
    group->runs.push_back(&run);
    summary.max_seeds = std::max(summary.max_seeds, group->runs.size());
  }
  return summary;
}

}  // namespace lumirank::pages
