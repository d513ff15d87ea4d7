#include "pages/summary.h"

#include <algorithm>

namespace lumirank::pages {

double CompareGroup::mean(const std::function<double(const CompareRun&)>& value) const {
  double sum = 0;
  for (const CompareRun* run : runs) sum += value(*run);
  return sum / static_cast<double>(runs.size());
}

double CompareGroup::lowest(const std::function<double(const CompareRun&)>& value) const {
  double min_value = value(first());
  for (const CompareRun* run : runs) min_value = std::min(min_value, value(*run));
  return min_value;
}

double CompareGroup::highest(const std::function<double(const CompareRun&)>& value) const {
  double max_value = value(first());
  for (const CompareRun* run : runs) max_value = std::max(max_value, value(*run));
  return max_value;
}

CompareSummary summarize(const CompareResults& results) {
  CompareSummary summary;
  for (const CompareRun& run : results.runs) {
    auto series = std::find(summary.series.begin(), summary.series.end(), run.series);
    if (series == summary.series.end()) series = summary.series.insert(series, run.series);
    const auto number = static_cast<std::size_t>(series - summary.series.begin());
    auto group = std::find_if(summary.groups.begin(), summary.groups.end(), [&](const CompareGroup& g) {
      return g.series == number && g.first().label == run.label;
    });
    if (group == summary.groups.end()) group = summary.groups.insert(group, CompareGroup{{}, number});
    group->runs.push_back(&run);
    summary.max_seeds = std::max(summary.max_seeds, group->runs.size());
  }
  return summary;
}

}  // namespace lumirank::pages
