// Passes of a budget use all of it, whatever one takes.
#include "pipeline/pass_plan.h"

#include <gtest/gtest.h>

#include <vector>

namespace lumirank::pipeline {
namespace {

struct Spent {
  std::vector<int> eighths;
  double seconds = 0;
};

// Passes that take what they take, planned by what a pilot believed.
Spent spend(double budget, double fixed, double per_eighth, double pilot_error, bool resizes = true,
            int parts = 1) {
  PassPlan plan(resizes, parts);
  plan.expect(pilot_error * fixed, pilot_error * per_eighth);
  Spent spent;
  while (const int eighths = plan.next(budget - spent.seconds)) {
    const double drawing = eighths * per_eighth;
    spent.eighths.push_back(eighths), spent.seconds += fixed + drawing;
    plan.took(eighths, fixed + drawing, drawing);
  }
  return spent;
}

TEST(PassPlan, UsesTheWholeBudgetAndNoMore) {
  for (const double pilot_error : {0.7, 1.0, 1.4})
    for (double budget = 4; budget < 40; budget += 0.37) {
      const Spent spent = spend(budget, 0.8, 0.15, pilot_error);  // 2 s for a whole pass
      EXPECT_LE(spent.seconds, budget) << budget << ", " << pilot_error;
      EXPECT_GT(spent.seconds, 0.88 * budget) << budget << ", " << pilot_error;
      if (budget > 10) {
        EXPECT_GT(spent.seconds, 0.94 * budget) << budget << ", " << pilot_error;
      }
    }
}

TEST(PassPlan, ThereAreThreePassesWhereTheyFit) {
  EXPECT_EQ(spend(5.2, 0.8, 0.15, 1).eighths.size(), 3u);
  EXPECT_EQ(spend(4, 0.8, 0.15, 1).eighths.size(), 2u);  // three of three eighths would
  EXPECT_GE(spend(8, 0.8, 0.15, 1).eighths.size(), 4u);
  // Nothing fits, yet there shall be a picture.
  EXPECT_EQ(spend(0.5, 0.8, 0.15, 1).eighths, std::vector<int>{3});
}

// Four show the film: whatever they take, there are four of them, and what is left after these is used.
TEST(PassPlan, PassesOfSomePixelsShowAllOfThem) {
  for (const double pilot_error : {0.7, 1.0, 1.4})
    for (double budget = 2; budget < 30; budget += 0.37) {
      const Spent spent = spend(budget, 0.2, 0.0375, pilot_error, true, 4);  // 2 s for a whole film
      EXPECT_GE(spent.eighths.size(), 4u) << budget << ", " << pilot_error;
      EXPECT_LE(spent.seconds, 1.02 * budget) << budget << ", " << pilot_error;
      EXPECT_GT(spent.seconds, 0.85 * budget) << budget << ", " << pilot_error;
    }
  // A film of large passes is as good as two of small ones.
  EXPECT_EQ(spend(2.7, 0.2, 0.0375, 1, true, 4).eighths.size(), 4u);
  EXPECT_EQ(spend(4, 0.2, 0.0375, 1, true, 4).eighths.size(), 8u);
  EXPECT_EQ(spend(0.5, 0.2, 0.0375, 1, true, 4).eighths, (std::vector<int>{3, 3, 3, 3}));
}

TEST(PassPlan, WholePassesAloneWhereTheMethodHasNoOthers) {
  const Spent spent = spend(9, 0.8, 0.15, 1, false);
  EXPECT_EQ(spent.eighths, (std::vector<int>{8, 8, 8, 8}));
}

}  // namespace
}  // namespace lumirank::pipeline
