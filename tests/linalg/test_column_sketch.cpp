#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "linalg/column_sketch.h"
#include "linalg/partition.h"

namespace lumirank::linalg {
namespace {

std::vector<float> random_row(std::size_t columns, std::uint64_t i) {
  std::vector<float> row(columns * 3);
  Rng rng(1, Stage::test, 20, i);
  for (float& v : row) v = rng.next_float();
  return row;
}

TEST(ColumnSketch, WithoutProjectionKeepsScalarsAndNorms) {
  const std::size_t n = 11, rows = 70;  // more than one batch
  ColumnSketch sketch({n, rows, false}, 1);
  std::vector<double> square(n * 4, 0.0);
  std::vector<float> scalar(n * rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const auto row = random_row(n, i);
    const float weight = i % 2 ? 1.0f : 2.0f;
    const double total = sketch.add_row(i, weight, row);
    double expected = 0;
    for (std::size_t j = 0; j < n; ++j) {
      double s = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double v = static_cast<double>(weight * row[j * 3 + c]);
        square[j * 4 + 1 + c] += v * v;
        s += v * v;
      }
      square[j * 4] += s;
      scalar[j * rows + i] = static_cast<float>(std::sqrt(s));
      expected += std::sqrt(s);
    }
    EXPECT_NEAR(total, expected, 4 * 0x1p-24 * expected);
  }
  const Points p = sketch.points();
  ASSERT_EQ(p.dimension, rows);
  PointReader reader(p);
  // Float sums of 70 terms: at most 70 · 2⁻²⁴ relative.
  const double rounding = 70 * 0x1p-24;
  for (std::size_t j = 0; j < n; ++j) {
    // Scalars are below 4, so in units of at most 2⁻¹³; waiting for their turn cost 2⁻¹² of themselves, and
    // flushing happens at most three times (70 rows, 32 at a time).
    for (std::size_t i = 0; i < rows; ++i)
      EXPECT_NEAR(reader[j][i], scalar[j * rows + i], 4 * 0x1p-12 + 1.5 * 0x1p-13);
    EXPECT_NEAR(sketch.norm(j), std::sqrt(square[j * 4]), rounding * std::sqrt(square[j * 4]));
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(sketch.channel_norm(j, c), std::sqrt(square[j * 4 + 1 + c]),
                  rounding * std::sqrt(square[j * 4]));
  }
}

std::vector<float> all_values(const Points& points) {
  std::vector<float> values;
  PointReader reader(points);
  for (std::size_t j = 0; j < points.count; ++j) {
    const auto x = reader[j];
    values.insert(values.end(), x.begin(), x.end());
  }
  return values;
}

// Two orthogonal columns of length 1: their projections are independent Gaussian vectors, so the expected
// cost of putting them together is 2·E‖x'‖·E‖y'‖ − 2·E[x'·y'] = 2κ², κ = √(2/r')·Γ((r'+1)/2)/Γ(r'/2), against
// the true cost 2: 1 % at r' = 50.
TEST(ColumnSketch, ProjectedCostIsTheTrueCostWithinOneInTwoDimensions) {
  const std::size_t dimension = 50, trials = 2000;
  const double kappa = std::sqrt(2.0 / dimension) *
                       std::exp(std::lgamma((dimension + 1) / 2.0) - std::lgamma(dimension / 2.0));
  double sum = 0, squares = 0, length = 0;
  for (std::size_t t = 0; t < trials; ++t) {
    ColumnSketch sketch({2, dimension}, t);
    sketch.add_row(0, 1, std::vector<float>{1, 0, 0, 0, 0, 0});
    sketch.add_row(1, 1, std::vector<float>{0, 0, 0, 1, 0, 0});
    const Points p = sketch.points();
    const auto norms = own_norms(p);
    const double cost = cluster_cost(p, norms, std::vector<std::uint32_t>{0, 1});
    sum += cost;
    squares += cost * cost;
    length += norms[0] * norms[0];
  }
  const double mean = sum / trials, deviation = std::sqrt(squares / trials - mean * mean);
  // Two-sided z-tests, confidence 99.9 % each.
  EXPECT_LT(std::abs(mean - 2 * kappa * kappa), 3.29 * deviation / std::sqrt(trials));
  // ‖x'‖²·r' is chi-square: variance 2/r' per trial.
  EXPECT_LT(std::abs(length / trials - 1), 3.29 * std::sqrt(2.0 / dimension / trials));
}

TEST(ColumnSketch, SameForAnyNumberOfThreadsAndAnyOrderOfIdsWithinRounding) {
  const std::size_t n = 30000;
  std::vector<float> first;
  for (int threads : {1, 2, 4})
    with_threads(threads, [&] {
      ColumnSketch sketch({n, 50}, 3);
      for (std::uint64_t i = 0; i < 40; ++i) sketch.add_row(i, 1, random_row(n, i));
      const std::vector<float> values = all_values(sketch.points());
      if (threads == 1) first = values;
      EXPECT_TRUE(values == first);
    });
  ColumnSketch backwards({n, 50}, 3);
  for (std::uint64_t i = 40; i-- > 0;) backwards.add_row(i, 1, random_row(n, i));
  const std::vector<float> turned = all_values(backwards.points());
  // 40 products below 2·√3 each, summed in single precision; rows that wait are off by 2⁻¹² of themselves (in
  // both orders alike), coordinates, which stay below 32, by half of 2⁻¹⁰ at each of two flushes in either.
  for (std::size_t k = 0; k < first.size(); k += 997)
    EXPECT_NEAR(turned[k], first[k], 40 * 40 * 2 * 0x1p-24 + 2 * 0x1p-10);
}

TEST(ColumnSketch, KnowsWhichColumnsVanish) {
  ColumnSketch sketch({3, 10}, 1);
  sketch.add_row(0, 1, std::vector<float>{0, 0, 0, 0, 1, 0, 0, 0, 0});
  EXPECT_TRUE(sketch.is_zero(0));
  EXPECT_FALSE(sketch.is_zero(1));
  EXPECT_EQ(sketch.channel_norm(1, 0), 0.0f);
  EXPECT_EQ(sketch.channel_norm(1, 1), 1.0f);
}

}  // namespace
}  // namespace lumirank::linalg
