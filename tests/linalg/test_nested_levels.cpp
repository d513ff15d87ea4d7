// Points from coarse to fine: sizes of levels, and that neighbors are the nearest.
#include "linalg/nested_levels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/random.h"

namespace lumirank::linalg {
namespace {

std::vector<NestedLevels::Point> random_points(std::size_t count) {
  std::vector<NestedLevels::Point> points(count);
  for (std::size_t k = 0; k < count; ++k) {
    Rng rng(1, Stage::test, 50, k);
    for (float& x : points[k]) x = rng.next_float();
  }
  return points;
}

float squared_distance(const NestedLevels::Point& a, const NestedLevels::Point& b) {
  float sum = 0;
  for (std::size_t d = 0; d < a.size(); ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return sum;
}

TEST(NestedLevels, HoldEveryPointOnceAndDouble) {
  NestedLevels levels;
  for (std::size_t count : {0u, 1u, 2u, 5u, 16u, 17u, 500u, 1024u}) {
    const auto points = random_points(count);
    levels.build(points, 16, 3);
    std::vector<std::uint32_t> seen(levels.coarsest().begin(), levels.coarsest().end());
    EXPECT_EQ(seen.size(), (count + 15) / 16);
    for (std::size_t l = 0; l < levels.levels(); ++l) {
      // As many again, rounded up; what is left at last.
      if (count == 1024) {
        EXPECT_NEAR(static_cast<double>(levels.level(l).size()), static_cast<double>(seen.size()), 2.0);
      }
      for (const auto& step : levels.level(l)) seen.push_back(step.point);
    }
    std::sort(seen.begin(), seen.end());
    ASSERT_EQ(seen.size(), count);
    for (std::size_t k = 0; k < count; ++k) EXPECT_EQ(seen[k], k);
  }
}

TEST(NestedLevels, NeighborsAreTheNearestCoarserPoints) {
  const auto points = random_points(300);
  NestedLevels levels;
  levels.build(points, 10, 4);
  std::vector<std::uint32_t> coarser(levels.coarsest().begin(), levels.coarsest().end());
  for (std::size_t l = 0; l < levels.levels(); ++l) {
    for (const auto& step : levels.level(l)) {
      std::vector<float> distances;
      for (std::uint32_t k : coarser) distances.push_back(squared_distance(points[k], points[step.point]));
      std::sort(distances.begin(), distances.end());
      for (std::size_t k = 0; k < NestedLevels::kNear; ++k) {
        EXPECT_NE(std::find(coarser.begin(), coarser.end(), step.near[k]), coarser.end());
        EXPECT_FLOAT_EQ(squared_distance(points[step.near[k]], points[step.point]), distances[k]);
      }
    }
    for (const auto& step : levels.level(l)) coarser.push_back(step.point);
  }
}

}  // namespace
}  // namespace lumirank::linalg
