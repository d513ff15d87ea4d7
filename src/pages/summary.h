// Runs that differ only by their seed, taken together.
#pragma once

#include <functional>
#include <vector>

#include "pages/results.h"

namespace lumirank::pages {

struct CompareGroup {
  std::vector<const CompareRun*> runs;  // at least one, in the order of the results
  std::size_t series = 0;               // index into CompareSummary::series

  const CompareRun& first() const { return *runs.front(); }
  double mean(const std::function<double(const CompareRun&)>& value) const;
  double lowest(const std::function<double(const CompareRun&)>& value) const;
  double highest(const std::function<double(const CompareRun&)>& value) const;
};

// Points into the results, which must live on.
struct CompareSummary {
  std::vector<std::string> series;   // in order of appearance
  std::vector<CompareGroup> groups;  // of one series and label, in order of appearance
  std::size_t max_seeds = 0;
};

CompareSummary summarize(const CompareResults& results);

}  // namespace lumirank::pages
