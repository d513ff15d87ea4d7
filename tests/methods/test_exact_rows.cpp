// The error's parts, as rows that were read tell them.
#include "methods/common/exact_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/common/row_sampler.h"
#include "support/statistics.h"

namespace lumirank::methods {
namespace {

using lumirank::test::mean_of;
using lumirank::test::student_quantile;

constexpr double kAlpha = 1e-4;  // false alarms per test

// Columns are random samples: entry (i, j) = base_i / columns · (1 + u), u uniform in (−1, 1) and different
// in each column and stretch of 8 rows; infinitely many add up to base.
struct Sampled {
  matrix::DenseMatrix matrix;
  std::vector<Rgb> limit;
};
Sampled sampled_columns(std::size_t rows, std::size_t columns, std::uint64_t seed) {
  std::vector<Rgb> entries(rows * columns), limit(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const float base =
        0.2f + std::sin(0.05f * static_cast<float>(i)) * std::sin(0.05f * static_cast<float>(i));
    limit[i] = Rgb(base, 0.5f * base, 0.25f * base);
    for (std::size_t j = 0; j < columns; ++j) {
      Rng rng(seed, Stage::test, i / 8, j);
      entries[i * columns + j] = limit[i] * (2 * rng.next_float() / static_cast<float>(columns));
    }
  }
  Sampled s{{rows, columns, std::move(entries)}, std::move(limit)};
  s.matrix.half.resize(columns);
  for (std::size_t j = 0; j < columns; ++j) s.matrix.half[j] = static_cast<std::uint8_t>(1 + (j & 1));
  return s;
}

// u is symmetric about 0, so A − B and A + B − limit have the same distribution, and so have the stated and
// the true error: a paired t-test.
TEST(ExactRows, LightsPartIsTheDistanceFromTheLimit) {
  std::vector<double> difference, stated;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Sampled s = sampled_columns(400, 30, seed);
    const double lights = read_rows(s.matrix, 50, seed).lights().value;
    stated.push_back(lights);
    difference.push_back(lights - relative_l1_difference(s.matrix.exact_sums(), s.limit));
  }
  const auto m = mean_of(difference);
  const double bound = student_quantile(kAlpha, 1, difference.size() - 1) * m.standard_error;
  EXPECT_NEAR(m.mean, 0, bound);
  EXPECT_LT(bound, 0.1 * mean_of(stated).mean);  // the test has teeth
  // √30 samples of a relative standard deviation of 1/√3, in the mean of an absolute normal deviate.
  EXPECT_NEAR(mean_of(stated).mean, std::sqrt(1.0 / 90) * std::sqrt(2 / M_PI), 0.004);
}

TEST(ExactRows, ExactColumnsHaveNoLightsPart) {
  Sampled s = sampled_columns(100, 20, 1);
  for (auto& half : s.matrix.half) half = 0;
  EXPECT_EQ(read_rows(s.matrix, 20, 1).lights().value, 0);
  s.matrix.half.clear();
  EXPECT_EQ(read_rows(s.matrix, 20, 1).lights().value, 0);
}

TEST(ExactRows, SamplingPartIsTheRelativeL1Error) {
  const auto m = matrix::low_rank_matrix({300, 100, 1}, 5);
  auto truth = m.exact_sums(), sums = truth;
  Rng rng(1, Stage::test);
  for (Rgb& s : sums) s *= 1 + 0.1f * static_cast<float>(rng.next_gaussian());
  // All rows: no sample, up to rounding of the sums.
  const ExactRows all = read_rows(m, m.rows(), 1);
  EXPECT_NEAR(all.sampling(sums).value, relative_l1_difference(sums, truth), 1e-5);
  EXPECT_NEAR(all.sampling(truth).value, 0, 1e-6);
}

// The 95 % intervals of 64 rows of 4,000 hold the error at all rows. Of 300 draws at least 88 % must (95 %
// less five standard deviations of the share, √(0.95 · 0.05/300) = 1.3 %).
TEST(ExactRows, IntervalsHoldTheErrorOfTheWholeImage) {
  const auto m = matrix::low_rank_matrix({4000, 20, 1}, 5);
  const auto truth = m.exact_sums();
  auto sums = truth;
  Rng rng(1, Stage::test);
  for (Rgb& s : sums) s *= 1 + 0.1f * static_cast<float>(rng.next_gaussian());
  const double error = relative_l1_difference(sums, truth);
  int held = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const ErrorPart part = read_rows(m, 64, seed).sampling(sums);
    held += std::abs(part.value - error) <= part.half_width;
  }
  EXPECT_GE(held, 264);
}

// Log-normal errors (σ = 1: half of the error is that of a sixth of the rows) and ones of σ = 1.5 (of a
// fifteenth): the intervals of 64 rows hold the error of all rows as often as they say. Of 300 draws at least
// 0.9 less four standard deviations of the share, √(0.9 · 0.1/300) = 1.7 %: a false alarm in 30,000. The
// symmetric interval of the same rows, at 95 %, does not even hold that for the second.
TEST(ExactRows, IntervalsForHeavyTailsHoldWhatTheySay) {
  const auto m = matrix::low_rank_matrix({4000, 20, 1}, 5);
  const auto truth = m.exact_sums();
  const int draws = 300;
  const int enough = static_cast<int>(draws * (kErrorConfidence - 4 * std::sqrt(0.09 / draws)));
  for (const float sigma : {1.0f, 1.5f}) {
    auto sums = truth;
    Rng rng(1, Stage::test);
    for (Rgb& s : sums) s *= 1 + 0.05f * std::exp(sigma * static_cast<float>(rng.next_gaussian()));
    const double error = relative_l1_difference(sums, truth);
    int held = 0, symmetric = 0;
    for (std::uint64_t seed = 0; seed < draws; ++seed) {
      const ErrorPart part = read_rows(m, 64, seed).sampling(sums);
      EXPECT_LE(part.low, part.value);
      EXPECT_GE(part.high, part.value);
      held += part.low <= error && error <= part.high;
      symmetric += std::abs(part.value - error) <= part.half_width;
    }
    EXPECT_GE(held, enough) << sigma;
    EXPECT_GT(held, symmetric) << sigma;
  }
}

TEST(ExactRows, IntervalsOfExactSumsAreEmpty) {
  const auto m = matrix::low_rank_matrix({100, 20, 1}, 5);
  ExactRows known = read_rows(m, 10, 1);
  std::vector<Rgb> sums(m.rows());
  for (const ExactRow& row : known.rows()) sums[row.from.row] = row.sum;
  const ErrorPart part = known.sampling(sums);
  EXPECT_EQ(part.value, 0);
  EXPECT_EQ(part.low, 0);
  EXPECT_EQ(part.high, 0);
}

// An error is relative to light: of rows without any none is stated.
TEST(ExactRows, DarkRowsTellNoError) {
  matrix::DenseMatrix m(100, 20, std::vector<Rgb>(2000));
  RunOptions options;
  options.target_error = 0.1;
  const RunClock clock(options);
  Trace trace;
  RowsForError(m, options, clock).state(std::vector<Rgb>(100, Rgb(1)), 20, trace);
  EXPECT_TRUE(trace.numbers.empty());
}

// Slice cuts read a twelfth of what they cost, and at least eight rows or none.
TEST(RowsForError, CountsByCost) {
  const auto m = matrix::low_rank_matrix({2000, 100, 1}, 5);
  RunOptions options;
  const RunClock clock(options);
  const auto sums = m.exact_sums();
  const auto rows_for = [&](double columns) {
    Trace trace;
    RowsForError rows(m, options, clock);
    rows.state(sums, columns, {0.08, 8}, trace);
    EXPECT_EQ(trace.numbers.contains("error.estimate.high"), rows.size() > 0);
    return rows.size();
  };
  EXPECT_EQ(rows_for(100), 64u);
  EXPECT_EQ(rows_for(20), 32u);
  EXPECT_EQ(rows_for(5), 8u);
  EXPECT_EQ(rows_for(4), 0u);
}

// Rows that were drawn more often than others weigh less, and rows that count less in the image too.
TEST(ExactRows, WeighsRows) {
  auto m = matrix::low_rank_matrix({2000, 20, 1}, 5);
  const auto truth = m.exact_sums();
  auto sums = truth;
  std::vector<float> density(m.rows());
  for (std::size_t i = 0; i < m.rows(); ++i) {
    density[i] = i < 500 ? 8.0f : 0.1f;
    sums[i] *= i < 500 ? 1.2f : 1.01f;
  }
  m.row_weight.assign(m.rows(), 1.0f);
  for (std::size_t i = 0; i < 1000; ++i) m.row_weight[i] = 0.25f;
  double over = 0, under = 0;
  for (std::size_t i = 0; i < m.rows(); ++i)
    for (int c = 0; c < 3; ++c) {
      over += static_cast<double>(m.row_weight[i] * std::abs(sums[i][c] - truth[i][c]));
      under += static_cast<double>(m.row_weight[i] * truth[i][c]);
    }
  std::vector<double> values;
  std::vector<Rgb> row(m.columns());
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    RowSampler sampler(m, seed);
    ExactRows known(m);
    for (const SampledRow& r : sampler.next_by_density(200, density)) known.read(r, row);
    values.push_back(known.sampling(sums).value);
  }
  const auto mean = mean_of(values);
  // A ratio of means is biased by about its variance over its mean: far less than the error of this mean.
  EXPECT_NEAR(mean.mean, over / under,
              student_quantile(kAlpha, 1, values.size() - 1) * mean.standard_error + 0.02 * over / under);
}

TEST(ExactRows, PartsAddUp) {
  const ErrorParts parts{{0.03, 0.01}, {0.04, 0.02}, {0.01, 0.005}};
  EXPECT_NEAR(parts.total().value, 0.06, 1e-12);
  EXPECT_NEAR(parts.total().half_width,
              std::sqrt(std::pow(0.6 * 0.01, 2) + std::pow(0.8 * 0.02, 2) + 0.005 * 0.005), 1e-12);
  EXPECT_EQ(ErrorParts{}.total().value, 0);
}

TEST(ExactRows, SamplingGetsWhatIsLeft) {
  EXPECT_NEAR(target_for_sampling(0.06, 0.04, 0.01), 0.03, 1e-12);
  EXPECT_EQ(target_for_sampling(0.06, 0, 0), 0.06);
  EXPECT_EQ(target_for_sampling(0.06, 0.0499, 0.01), 0.03);  // √(0.05² − 0.0499²) = 0.003: too little
  EXPECT_EQ(target_for_sampling(0.06, 0.04, 0.07), 0.03);
}

}  // namespace
}  // namespace lumirank::methods
