// The tests' own verdicts, where they are known in closed form.
#include "support/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "base/random.h"

namespace lumirank::test {
namespace {

TEST(Statistics, ChiSquareTailOfKnownQuantiles) {
  // Two degrees: exp(-x/2). One degree: the two-sided normal tail, 5 % at 1.959964².
  EXPECT_NEAR(chi_square_tail(3.0, 2), std::exp(-1.5), 1e-12);
  EXPECT_NEAR(chi_square_tail(1.959963985 * 1.959963985, 1), 0.05, 1e-9);
  EXPECT_NEAR(chi_square_tail(10, 2), std::exp(-5.0), 1e-12);
}

TEST(Statistics, QuantilesOfTables) {
  EXPECT_NEAR(normal_quantile(0.05), 1.959963985, 1e-8);
  EXPECT_NEAR(normal_quantile(0.05, 5), normal_quantile(0.01), 1e-12);
  EXPECT_NEAR(student_quantile(0.05, 1, 10), 2.228138852, 0.01);
  EXPECT_NEAR(student_quantile(0.001, 1, 20), 3.849516, 0.04);
}

TEST(Statistics, RunningMeanIsTheMean) {
  std::vector<double> values;
  RunningMean running;
  Rng rng(1, Stage::test);
  for (int k = 0; k < 1000; ++k) values.push_back(rng.next_double()), running.add(values.back());
  const Mean m = mean_of(values);
  EXPECT_NEAR(running.mean(), m.mean, 1e-12);
  EXPECT_NEAR(running.standard_error(), m.standard_error, 1e-12);
}

// A fair die is passed, a loaded one is not; rare sides are pooled.
TEST(Statistics, ChiSquareTestOfDice) {
  const auto tail = [](double load) {
    std::array<double, 6> seen{};
    Rng rng(2, Stage::test);
    for (int k = 0; k < 6000; ++k)
      ++seen[rng.next_double() < load ? 0 : static_cast<std::size_t>(rng.next_below(6))];
    ChiSquareTest test;
    for (const double s : seen) test.add(s, 1000);
    EXPECT_EQ(test.bins(), 6);
    return test.tail();
  };
  EXPECT_GT(tail(0), 1e-3);
  EXPECT_LT(tail(0.05), 1e-5);
  ChiSquareTest pooled;
  pooled.add(100, 90), pooled.add(4, 6), pooled.add(3, 6);
  EXPECT_EQ(pooled.bins(), 2);
  EXPECT_NEAR(pooled.statistic(), 100.0 / 90 + 25.0 / 12, 1e-12);
}

}  // namespace
}  // namespace lumirank::test
