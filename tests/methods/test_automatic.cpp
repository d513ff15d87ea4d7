// Without given numbers of rows and columns.
#include <gtest/gtest.h>

#include <cmath>

#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/row_column/planner.h"
#include "methods/row_column/settings.h"
#include "support/sanitizers.h"

namespace lumirank::methods {
namespace {

Estimate run_planned(const matrix::LightingMatrix& m, const SettingsMap& settings,
                     const RunOptions& options) {
  return find_method("row-column-sampling").make(settings)->run(m, options);
}

struct Spread {
  double error = 0, predicted = 0, stated = 0, columns = 0;  // means over seeds, errors relative L1
  int met = 0;
};
Spread over_seeds(const matrix::DenseMatrix& m, double target, int seeds) {
  const auto truth = m.exact_sums();
  Spread s;
  for (int seed = 1; seed <= seeds; ++seed) {
    RunOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    options.target_error = target;
    const Estimate e = run_planned(m, {}, options);
    s.error += relative_l1_difference(e.sums, truth) / seeds;
    s.predicted += e.trace.numbers.at("predicted_error") / seeds;
    s.stated += e.trace.numbers.at("error.estimate") / seeds;
    s.columns += e.trace.numbers.at("columns") / seeds;
    s.met += !e.trace.notes.contains("target");
    EXPECT_EQ(e.trace.numbers.at("error.lights"), 0);  // these columns are no samples of anything
    EXPECT_EQ(e.trace.numbers.at("error.estimate"), e.trace.numbers.at("error.sampling"));
  }
  return s;
}

// Of 8 runs (2 under sanitizers), each with 64 held-out rows: an L1 error at one row varies by about its own
// size, so the mean over 512 (128) rows by 4.4 % (8.8 %); five and a half times that is allowed. Predicted
// errors are those of normal deviates; of the same variance, errors with heavier tails have a smaller mean,
// so the prediction may only be too large.
TEST(Automatic, ReachesItsTargetAndSaysSo) {
  const int runs = lumirank::test::kSanitized ? 2 : 8;
  const double wide = 1 + 5.5 / std::sqrt(64.0 * runs);
  const auto smooth = matrix::low_rank_matrix({2048, 3000, 1}, 60);
  const auto sparse = matrix::sparse_matrix({2048, 3000, 1}, 0.2);
  for (const matrix::DenseMatrix* m : {&smooth, &sparse})
    for (double target : {0.1, 0.05}) {
      const Spread s = over_seeds(*m, target, runs);
      EXPECT_EQ(s.met, runs);
      EXPECT_LE(s.stated, target);
      EXPECT_LT(s.error, wide * s.stated);
      EXPECT_GT(s.error, s.stated / wide);
      EXPECT_LT(s.error, wide * s.predicted);
      EXPECT_GT(s.error, 0.5 * s.predicted);
    }
}

TEST(Automatic, SmallerTargetsTakeMoreColumns) {
  const auto m = matrix::sparse_matrix({2048, 3000, 1}, 0.2);
  EXPECT_LT(over_seeds(m, 0.1, 2).columns, over_seeds(m, 0.05, 2).columns);
}

TEST(Automatic, LowRankNeedsFewColumns) {
  const auto m = matrix::clustered_matrix({2000, 3000, 1}, 20);
  RunOptions options;
  const Estimate e = run_planned(m, {}, options);
  EXPECT_LE(e.trace.numbers.at("columns"), 100);
  EXPECT_LT(relative_difference(e.sums, m.exact_sums()), 0.02);
}

// Where nothing can be learned from rows, so many columns are needed that all are rendered.
TEST(Automatic, GivesUpOnClusteringWhereItDoesNotPay) {
  const auto m = matrix::recess_matrix({1000, 600, 1});
  RunOptions options;
  options.target_error = 0.001;
  const Estimate e = run_planned(m, {}, options);
  EXPECT_EQ(e.trace.numbers.at("columns"), 600);
  EXPECT_LT(relative_difference(e.sums, m.exact_sums()), 600 * 0x1p-24);
}

TEST(Automatic, KeepsGivenNumbers) {
  const auto m = matrix::low_rank_matrix({600, 1000, 1}, 40);
  const Estimate rows = run_planned(m, {{"rows", "123"}}, {});
  EXPECT_EQ(rows.trace.numbers.at("rows"), 123);
  const Estimate columns = run_planned(m, {{"columns", "200"}}, {});
  EXPECT_EQ(columns.trace.numbers.at("clusters"), 200);
}

TEST(Automatic, TimeBudgetGivesACompleteEstimate) {
  const auto m = matrix::low_rank_matrix({1000, 2000, 1}, 40);
  for (double seconds : {1e-6, 0.01}) {
    RunOptions options;
    options.time_seconds = seconds;
    const Estimate e = run_planned(m, {}, options);
    EXPECT_FALSE(e.interrupted);
    EXPECT_LT(relative_difference(e.sums, m.exact_sums()),
              1.0);  // some columns were rendered and stand for all
  }
}

TEST(Planner, InterpolatesPowersExactly) {
  // errors 1/c and 1/√c are straight lines in logarithms.
  ErrorCurve curve;
  for (double c : {32.0, 64.0, 128.0}) curve.points.push_back({c, 1 / c, 1 / std::sqrt(c)});
  EXPECT_NEAR(curve.seen(50), 1 / 50.0, 1e-12);
  EXPECT_NEAR(curve.unseen(1000), 1 / std::sqrt(1000.0), 1e-12);
  EXPECT_NEAR(curve.columns_for_seen(0.01), 100, 1e-9);
  EXPECT_NEAR(curve.columns_for_unseen(0.02), 2500, 1e-8);
  EXPECT_EQ(curve.columns_for_seen(0.5), 32);
}

TEST(Planner, WeighsRowsAgainstColumns) {
  ErrorCurve curve;
  for (double c : {32.0, 64.0, 128.0}) curve.points.push_back({c, 1 / c, 1 / std::sqrt(c)});
  // Target 0.02: 2500 columns by unseen rows, 50 by seen ones; half of the gap is 1225 columns.
  EXPECT_TRUE(more_rows_pay_for_target(curve, {0.02, 1224, 1e9}, {1, 1}));
  EXPECT_FALSE(more_rows_pay_for_target(curve, {0.02, 1226, 1e9}, {1, 1}));
  EXPECT_FALSE(more_rows_pay_for_target(curve, {0.02, 613, 1e9}, {2, 1}));
  // Rows that saved 500 columns before will not save more now.
  EXPECT_FALSE(more_rows_pay_for_target(curve, {0.02, 600, 1e9, 3000}, {1, 1}));
  EXPECT_TRUE(more_rows_pay_for_target(curve, {0.02, 400, 1e9, 3000}, {1, 1}));
  // 1000 to spend: now 1/√1000 = 0.0316; with 100 rows more 900^(−3/8 − 1/4) = 0.0142.
  EXPECT_TRUE(more_rows_pay_for_budget(curve, 1000, 100, {1, 1}));
  // 250 rows more leave 750 columns beside 500 rows: too many rows.
  EXPECT_FALSE(more_rows_pay_for_budget(curve, 1000, 250, {1, 1}));
  // Where unseen rows show what seen ones do, there is nothing to learn: (1/900) against (1/1000).
  ErrorCurve learned;
  for (double c : {32.0, 64.0, 128.0}) learned.points.push_back({c, 1 / c, 1 / c});
  EXPECT_FALSE(more_rows_pay_for_budget(learned, 1000, 100, {1, 1}));
}

}  // namespace
}  // namespace lumirank::methods
