// Methods with columns per slice under a time budget: it chooses slices and columns, not the clock alone
// where the pass ends.
#include <gtest/gtest.h>

#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/common/timed_choices.h"

namespace lumirank::methods {
namespace {

class TimedSlices : public testing::TestWithParam<const char*> {
 protected:
  Estimate run(double seconds, TimedChoices* choices = nullptr) const {
    RunOptions options;
    options.time_seconds = seconds;
    options.choices = choices;
    return find_method(GetParam())
        .make({{"columns", "60"}, {"slice-rows", "50"}, {"initial-clusters", "20"}})
        ->run(matrix_, options);
  }
  // Dense enough that no column is zero on the rows that a slice reads.
  matrix::DenseMatrix matrix_ = matrix::low_rank_matrix({400, 900, 1}, 5);
};

// Repeated choices ask no clock.
TEST_P(TimedSlices, RowsAndColumnsFollowTheChoices) {
  TimedChoices choices({{"coarse_rows", {2}},
                        {"coarse_columns", {2}},
                        {"exact_rows", {0}},
                        {"slices", {4}},
                        {"slice_rows", {4}},
                        {"turn_quality", {64, 0}},
                        {"units", {4, 4}}});
  const auto numbers = run(1e-6, &choices).trace.numbers;
  choices.expect_end();
  EXPECT_EQ(numbers.at("slices"), 4);
  EXPECT_EQ(numbers.at("rows"), 4);
  EXPECT_EQ(numbers.at("columns"), 30);  // as many of 60 as slices of 8
  EXPECT_EQ(numbers.at("turns"), 1);
}

// Clusters of all slices, and one more for what is split further.
TEST_P(TimedSlices, FewestColumnsAreTheClustersOfAllSlices) {
  TimedChoices choices({{"coarse_rows", {2}},
                        {"coarse_columns", {2}},
                        {"exact_rows", {0}},
                        {"slices", {4}},
                        {"slice_rows", {4}},
                        {"turn_quality", {1, 0}},
                        {"units", {4, 4}}});
  EXPECT_EQ(run(1e-6, &choices).trace.numbers.at("columns"), 21);
}

TEST_P(TimedSlices, NoTimeIsTheCoarsePicture) {
  TimedChoices choices;
  const Estimate e = run(1e-9, &choices);
  EXPECT_EQ(e.trace.numbers.at("budget.coarse_share"), 1);
  for (const Rgb v : e.sums) EXPECT_TRUE(is_finite(v) && !is_black(v));
}

// More columns than there are lights: exact, up to sums of 900 floats in another order.
TEST_P(TimedSlices, MuchTimeIsExact) {
  EXPECT_LT(relative_difference(run(1e6).sums, matrix_.exact_sums()), 900 * 0x1p-24);
}

INSTANTIATE_TEST_SUITE_P(All, TimedSlices, testing::Values("lightslice", "visibility-completion"),
                         [](const auto& p) {
                           return std::string(p.param).substr(0, std::string(p.param).find('-'));
                         });

}  // namespace
}  // namespace lumirank::methods
