#include "study/run_plan.h"

#include <gtest/gtest.h>

#include <set>

namespace lumirank::study {
namespace {

std::set<std::string> curves(const CompareSettings& settings) {
  std::set<std::string> names;
  for (const PlannedRun& run : plan_runs(settings)) names.insert(run.series);
  return names;
}

// A line through runs of different sweeps would mean nothing.
TEST(ComparePlan, EverySweepIsACurveOfItsOwn) {
  CompareSettings settings;
  settings.methods = {"row-column-sampling", "brute-force"};
  settings.times = {0.5, 1};
  EXPECT_EQ(curves(settings), (std::set<std::string>{"row-column-sampling", "brute-force"}));
  settings.sweeps = {{"row-column-sampling", {"rows", "columns"}, {{"50", "100"}, {"100", "200"}}}};
  EXPECT_EQ(curves(settings), (std::set<std::string>{"row-column-sampling (rows=50 columns=100 …)",
                                                     "row-column-sampling (0.5 s …)", "brute-force"}));
  settings.times.clear();
  settings.sweeps.push_back({"row-column-sampling", {"columns"}, {{"100"}}});
  EXPECT_EQ(curves(settings), (std::set<std::string>{"row-column-sampling (rows=50 columns=100 …)",
                                                     "row-column-sampling (columns=100 …)", "brute-force"}));
}

}  // namespace
}  // namespace lumirank::study
