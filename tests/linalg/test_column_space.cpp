// Columns completed from few of their rows, against what they are.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/random.h"
#include "linalg/column_space.h"

namespace lumirank::linalg {
namespace {

constexpr std::size_t kSpaceRows = 200, kWidth = 3, kLength = kSpaceRows * kWidth;

// Columns of a space of `rank` dimensions, with `noise` of their own.
class LowRank {
 public:
  LowRank(std::size_t rank, std::uint64_t seed) : rng_(seed, Stage::test) {
    for (std::size_t d = 0; d < rank; ++d) {
      factors_.emplace_back(kLength);
      for (float& x : factors_.back()) x = static_cast<float>(rng_.next_gaussian());
    }
  }
  std::vector<float> column(float noise = 0) {
    std::vector<float> out(kLength, 0.0f);
    for (const auto& factor : factors_) {
      const float share = rng_.next_float();
      for (std::size_t k = 0; k < kLength; ++k) out[k] += share * factor[k];
    }
    for (float& x : out) x += noise * static_cast<float>(rng_.next_gaussian());
    return out;
  }

 private:
  Rng rng_;
  std::vector<std::vector<float>> factors_;
};

std::vector<std::uint32_t> every(std::size_t step) {
  std::vector<std::uint32_t> rows;
  for (std::uint32_t a = 0; a < kSpaceRows; a += static_cast<std::uint32_t>(step)) rows.push_back(a);
  return rows;
}

std::vector<float> of_rows(const std::vector<float>& column, std::span<const std::uint32_t> rows) {
  std::vector<float> out;
  for (const std::uint32_t a : rows)
    for (std::size_t c = 0; c < kWidth; ++c) out.push_back(column[a * kWidth + c]);
  return out;
}

double distance(std::span<const float> a, std::span<const float> b) {
  double square = 0, size = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    square += std::pow(static_cast<double>(a[k]) - static_cast<double>(b[k]), 2);
    size += std::pow(static_cast<double>(b[k]), 2);
  }
  return std::sqrt(square / size);
}

TEST(ColumnSpace, ColumnsWithinAreExactFromATwentiethOfTheirRows) {
  LowRank matrix(6, 1);
  ColumnSpace space;
  space.begin(kSpaceRows, kWidth);
  std::vector<float> coordinates, out(kLength);
  for (int k = 0; k < 9; ++k) {
    const auto column = matrix.column();
    space.add(column, coordinates);
    space.combine(coordinates, out);
    EXPECT_LT(distance(out, column), 1e-5) << k;
  }
  EXPECT_EQ(space.rank(), 6u);
  const auto rows = every(20);
  space.sample(rows);
  for (int k = 0; k < 20; ++k) {
    const auto column = matrix.column();
    const auto fit = space.fit(of_rows(column, rows), coordinates);
    space.combine(coordinates, out);
    EXPECT_LT(distance(out, column), 1e-4);
    EXPECT_LT(fit.left_out, 1e-3 * fit.size);
  }
}

// The residual of a fit is small where there are hardly more rows than directions, whatever the column is
// elsewhere. What rows foretell of each other tells: it is near what the fit is off by in all rows, and never
// far below.
TEST(ColumnSpace, RowsThatAreLeftOutTellTheErrorElsewhere) {
  LowRank matrix(5, 2);
  ColumnSpace space;
  space.begin(kSpaceRows, kWidth);
  std::vector<float> coordinates, out(kLength);
  for (int k = 0; k < 5; ++k) space.add(matrix.column(), coordinates);
  for (const std::size_t step : {50u, 20u, 8u}) {
    const auto rows = every(step);
    space.sample(rows);
    double told = 0, is = 0, fitted = 0;
    constexpr int kColumns = 200;
    for (int k = 0; k < kColumns; ++k) {
      const auto column = matrix.column(0.2f);
      const auto fit = space.fit(of_rows(column, rows), coordinates);
      space.combine(coordinates, out);
      told += std::pow(fit.left_out, 2) / static_cast<double>(rows.size());
      fitted += std::pow(fit.residual, 2) / static_cast<double>(rows.size());
      double square = 0;
      for (std::size_t j = 0; j < kLength; ++j)
        square += std::pow(static_cast<double>(out[j]) - static_cast<double>(column[j]), 2);
      is += square / kSpaceRows;
    }
    EXPECT_GT(told, 0.8 * is) << step;
    EXPECT_LT(told, 4 * is) << step;
    EXPECT_LT(fitted, 0.96 * is) << step;
  }
}

TEST(ColumnSpace, SampledRowsThatSeeNothingGiveNothing) {
  ColumnSpace space;
  space.begin(kSpaceRows, kWidth);
  std::vector<float> column(kLength, 0.0f), coordinates;
  column[7] = 1;
  space.add(column, coordinates);
  const std::vector<std::uint32_t> rows{50, 60, 70};
  space.sample(rows);
  const auto fit = space.fit(std::vector<float>(9, 1.0f), coordinates);
  ASSERT_EQ(coordinates.size(), 1u);
  EXPECT_EQ(coordinates[0], 0.0f);
  EXPECT_NEAR(fit.left_out, fit.size, 1e-4 * fit.size);
}

// A speck in a row that is not sampled, with a little beside it that is: a column with that little in it is
// no reason to foretell a hundred specks.
TEST(ColumnSpace, SpecksOutsideOfTheSampledRowsAreNotMultiplied) {
  ColumnSpace space;
  space.begin(kSpaceRows, kWidth);
  std::vector<float> speck(kLength, 1e-3f), coordinates, out(kLength);
  speck[kWidth] = 1;
  space.add(speck, coordinates);
  const auto rows = every(8);
  space.sample(rows);
  space.fit(std::vector<float>(rows.size() * kWidth, 1.0f), coordinates);
  space.combine(coordinates, out);
  for (const float x : out) EXPECT_LT(std::abs(x), 2);
}

TEST(ColumnSpace, DarkColumnsAddNoDirection) {
  ColumnSpace space;
  space.begin(kSpaceRows, kWidth);
  std::vector<float> coordinates;
  space.add(std::vector<float>(kLength, 0.0f), coordinates);
  EXPECT_EQ(space.rank(), 0u);
  EXPECT_TRUE(coordinates.empty());
}

}  // namespace
}  // namespace lumirank::linalg
