#include "pages/summary.h"

#include <algorithm>

namespace lumirank::pages {

double ComparisonGroup::mean(const std::function<double(const ComparisonRun&)>& value) const {
  double sum = 0;
  for (const ComparisonRun* run : runs) sum += value(*run);
  return sum / static_cast<double>(runs.size());
}

double ComparisonGroup::lowest(const std::function<double(const ComparisonRun&)>& value) const {
  double least = value(first());
  for (const ComparisonRun* run : runs) least = std::min(least, value(*run));
  return least;
}

double ComparisonGroup::highest(const std::function<double(const ComparisonRun&)>& value) const {
  double most = value(first());
  for (const ComparisonRun* run : runs) most = std::max(most, value(*run));
  return most;
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
    summary.most_seeds = std::max(summary.most_seeds, group->runs.size());
  }
  return summary;
}

}  // namespace lumirank::pages
