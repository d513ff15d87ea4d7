#include "pages/summary.h"

#include <algorithm>

namespace lumirank::pages {

double CompareGroup::mean(const std::function<double(const CompareRun&)>& value) const {
  double sum = 0;
  for (const CompareRun* run : runs) sum += value(*run);
  return sum / static_cast<double>(runs.size());
}

double CompareGroup::lowest(const std::function<double(const CompareRun&)>& value) const {
  double least = value(first());
  for (const CompareRun* run : runs) least = std::min(least, value(*run));
  return least;
}

double CompareGroup::highest(const std::function<double(const CompareRun&)>& value) const {
  double most = value(first());
  for (const CompareRun* run : runs) most = std::max(most, value(*run));
  return most;
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
    summary.most_seeds = std::max(summary.most_seeds, group->runs.size());
  }
  return summary;
}

}  // namespace lumirank::pages
