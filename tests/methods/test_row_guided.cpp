// Row-guided sampling: its distributions, what the mixture draws and says of itself, and its mean.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "base/random.h"
#include "matrix/synthetic.h"
#include "methods/method.h"
#include "methods/row_guided_sampling/light_records.h"
#include "methods/row_guided_sampling/record_draws.h"
#include "methods/row_guided_sampling/running_sum.h"

namespace lumirank::methods {
namespace {

struct OwnedSum {
  explicit OwnedSum(const std::vector<float>& weights) : numbers(weights.size() + 1), size(weights.size()) {
    lit = RunningSum::write(weights, numbers.data(), 1);
  }
  RunningSum sum() const { return {numbers.data(), size, 1}; }
  std::vector<std::uint32_t> numbers;
  std::size_t size;
  bool lit;
};

TEST(RunningSum, EvenStepsMeetColumnsAsOftenAsTheirProbabilitiesSay) {
  const OwnedSum owned({3, 0, 1, 0.5f, 0, 5.5f});
  ASSERT_TRUE(owned.lit);
  std::vector<int> met(6);
  constexpr int kSteps = 100000;
  for (int k = 0; k < kSteps; ++k) ++met[owned.sum().draw((k + 0.5) / kSteps)];
  const float weights[] = {3, 0, 1, 0.5f, 0, 5.5f};
  for (std::uint32_t j = 0; j < 6; ++j) {
    EXPECT_NEAR(met[j], kSteps * weights[j] / 10, 1.01) << j;
    EXPECT_NEAR(owned.sum().probability(j), weights[j] / 10, 1e-6f) << j;
  }
}

TEST(RunningSum, TheFaintestColumnCanBeDrawnAndTheDarkCannot) {
  const OwnedSum owned({1e-30f, 0, 1e30f, 0});
  EXPECT_GE(owned.sum().units(0), 1u);
  EXPECT_EQ(owned.sum().units(1), 0u);
  EXPECT_EQ(owned.sum().draw(0), 0u);
  EXPECT_EQ(owned.sum().draw(0x1.fffffffffffffp-1), 2u);
  const OwnedSum dark({0, 0, 0});
  EXPECT_FALSE(dark.lit);
  EXPECT_TRUE(dark.sum().empty());
}

TEST(SpreadFraction, AnyStretchOfTwoToTheKIsInDifferentParts) {
  for (const std::uint64_t begin : {0ull, 64ull, 6400ull}) {
    std::set<int> parts;
    for (std::uint64_t k = 0; k < 64; ++k) {
      const double u = spread_fraction(begin + k, 7);
      ASSERT_GE(u, 0);
      ASSERT_LT(u, 1);
      parts.insert(static_cast<int>(64 * u));
    }
    EXPECT_EQ(parts.size(), 64u) << begin;
  }
}

// Even numbers are in the lower half as often as in the upper one: neighbors share no pattern over the
// picture.
TEST(SpreadFraction, BlocksAreScrambledApart) {
  for (std::uint64_t mask = 1; mask < 64; mask *= 2) {
    int low = 0, all = 0;
    for (std::uint64_t k = 0; k < 64 * 256; ++k)
      if ((k & mask) == 0) ++all, low += spread_fraction(k, 7) < 0.5 ? 1 : 0;
    EXPECT_NEAR(static_cast<double>(low) / all, 0.5, 0.13) << mask;  // 4 deviations of 256 flips
  }
}

TEST(BoundedDistribution, GoesByPowerDistanceAndDirections) {
  // Points straight above a floor; a surface that faces it, and one that faces away.
  const std::vector<Vec3f> positions{{0, 0, 1}, {0, 0, 3}, {0, 0, 1}, {0, 0, 1}};
  const std::vector<Vec3f> normals{{}, {}, {0, 0, -1}, {0, 0, 1}};
  const std::vector<float> power{1, 2, 1, 1};
  matrix::ColumnFeatures columns;
  columns.position = positions, columns.normal = normals, columns.power = power;
  const std::vector<Vec3f> place{{0, 0, 0}}, up{{0, 0, 1}};
  matrix::RowFeatures rows;
  rows.position = place, rows.normal = up;
  const std::vector<matrix::Index> group{0};
  BoundedDistribution bounded;
  EXPECT_TRUE(bounded.empty());
  bounded.update({columns, 4}, rows, group);
  ASSERT_FALSE(bounded.empty());
  EXPECT_NEAR(bounded.probability(1) / bounded.probability(0), 2.0 / 9, 1e-5);
  EXPECT_NEAR(bounded.probability(2) / bounded.probability(0), 4, 1e-4);  // 1/π beside 1/(4π)
  EXPECT_GT(bounded.probability(3), 0);
  EXPECT_LT(bounded.probability(3), bounded.probability(0));
  std::vector<int> met(4);
  constexpr int kSteps = 10000;
  for (int k = 0; k < kSteps; ++k) ++met[bounded.draw((k + 0.5) / kSteps)];
  for (matrix::Index j = 0; j < 4; ++j)
    EXPECT_NEAR(met[j], kSteps * static_cast<double>(bounded.probability(j)), 1.01) << j;
}

TEST(BoundedDistribution, KnowsNothingWithoutPlaces) {
  const std::vector<float> power{1, 2};
  matrix::ColumnFeatures columns;
  columns.power = power;
  BoundedDistribution bounded;
  const std::vector<matrix::Index> group{0};
  bounded.update({columns, 2}, {}, group);
  EXPECT_TRUE(bounded.empty());
}

// Probabilities of all columns add up to 1, and draws are as frequent as they say.
TEST(RecordMixture, SaysWithWhatProbabilityItDraws) {
  auto matrix = matrix::sparse_matrix({40, 60, 1}, 0.3);
  Rng rng(1, Stage::test);
  const auto place = [&] { return Vec3f{rng.next_float(), rng.next_float(), rng.next_float()}; };
  std::generate_n(std::back_inserter(matrix.row_position), 40, place);
  std::generate_n(std::back_inserter(matrix.column_position), 60, place);
  matrix.column_normal.resize(60), matrix.power.assign(60, 1.0f);
  const std::vector<matrix::Index> rows{3, 11, 17, 28, 35};
  const LightRecords records(matrix, rows, [](std::size_t) { return true; });
  ASSERT_EQ(records.size(), rows.size());
  BoundedDistribution bounded;
  const std::vector<matrix::Index> group{18, 19, 20, 21};
  bounded.update({matrix.column_features(), matrix.columns()}, matrix.row_features(), group);
  ASSERT_FALSE(bounded.empty());
  const RecordMixture mixture(records, bounded, 20);
  constexpr int kSteps = 60000;
  std::vector<int> met(60);
  std::vector<float> probability(60);
  std::vector<GuidedColumn> all(kSteps);
  mixture.draw(0.5, all);
  for (const GuidedColumn& drawn : all) {
    ++met[drawn.column], probability[drawn.column] = drawn.probability;
    EXPECT_GT(drawn.visible, 0);
    EXPECT_LE(drawn.visible, 1);
  }
  double sum = 0;
  for (std::size_t j = 0; j < 60; ++j) {
    sum += static_cast<double>(probability[j]);
    // Each of the ten distributions may gain or lose a step at either end of its column.
    EXPECT_NEAR(met[j], kSteps * static_cast<double>(probability[j]), 20.1) << j;
  }
  EXPECT_NEAR(sum, 1, 1e-5);  // all columns have power, so all were met
}

TEST(LightRecords, AreSpreadAndNearestComesFirst) {
  const auto matrix = matrix::low_rank_matrix({500, 40, 1}, 5);
  const auto chosen = choose_records(matrix, {32, 1});
  EXPECT_EQ(std::set<matrix::Index>(chosen.begin(), chosen.end()).size(), chosen.size());
  EXPECT_LE(chosen.size(), 32u);
  EXPECT_GE(chosen.size(), 16u);
  std::size_t asked = 0;
  const LightRecords some(matrix, chosen, [&](std::size_t read) { return ++asked, read < 3; });
  EXPECT_EQ(some.size(), 3u);
  EXPECT_EQ(some.nearest(chosen[1])[0], 1u);
  EXPECT_EQ(some.nearest(chosen[1])[3], LightRecords::kNone);
}

}  // namespace
}  // namespace lumirank::methods
