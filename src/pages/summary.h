// Runs that differ only by their seed, taken together.
#pragma once

#include <functional>
#include <vector>

#include "lumirank/compare.h"

namespace lumirank::pages {

struct ComparisonGroup {
  std::vector<const ComparisonRun*> runs;  // at least one, in the order of the results
  std::size_t series = 0;                  // index into ComparisonSummary::series

  const ComparisonRun& first() const { return *runs.front(); }
  double mean(const std::function<double(const ComparisonRun&)>& value) const;
  double lowest(const std::function<double(const ComparisonRun&)>& value) const;
  double highest(const std::function<double(const ComparisonRun&)>& value) const;
};

// Points into the results, which must live on.
struct ComparisonSummary {
  std::vector<std::string> series;      // in order of appearance
  std::vector<ComparisonGroup> groups;  // of one series and label, in order of appearance
  std::size_t max_seeds = 0;
};

ComparisonSummary summarize(const Comparison& results);

}  // namespace lumirank::pages
