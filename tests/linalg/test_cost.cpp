// The cost of a cluster, the best cut, and the edge costs, each against its definition in 2007, sections 3.4
// and 3.5.
#include <gtest/gtest.h>

#include <cmath>

#include "linalg/multiset_sampling.h"
#include "linalg/splitting.h"
#include "linalg/test_data.h"

namespace lumirank::linalg {
namespace {

using namespace test;

// d(x,y) = ½‖x‖‖y‖·‖x̄ − ȳ‖²
double distance(const PointCloud& p, std::size_t i, std::size_t j) {
  double nx = 0, ny = 0, d2 = 0;
  for (std::size_t d = 0; d < p.dimension; ++d) {
    nx += std::pow(static_cast<double>(p[i][d]), 2);
    ny += std::pow(static_cast<double>(p[j][d]), 2);
  }
  nx = std::sqrt(nx), ny = std::sqrt(ny);
  for (std::size_t d = 0; d < p.dimension; ++d)
    d2 += std::pow(static_cast<double>(p[i][d]) / nx - static_cast<double>(p[j][d]) / ny, 2);
  return 0.5 * nx * ny * d2;
}

double pairwise_cost(const PointCloud& p, std::span<const std::uint32_t> members) {
  double cost = 0;
  for (std::uint32_t i : members)
    for (std::uint32_t j : members) cost += distance(p, i, j);
  return cost;
}

TEST(Cost, EqualsThePairwiseDefinition) {
  const PointCloud cloud = random_cloud(60, 7, 1);
  const auto all = all_of(cloud);
  const auto norms = own_norms(cloud.points());
  const double expected = pairwise_cost(cloud, all);
  // Both are sums in double precision of numbers up to (Σ‖x‖)²: a relative 1e-12 is four digits above
  // rounding.
  EXPECT_NEAR(cluster_cost(cloud.points(), norms, all), expected, 1e-12 * expected);
}

TEST(Cost, IsZeroForParallelPoints) {
  PointCloud cloud = directed_cloud(50, 9, 1, 2);
  const auto norms = own_norms(cloud.points());
  double weight = 0;
  for (double n : norms) weight += n;
  EXPECT_LE(cluster_cost(cloud.points(), norms, all_of(cloud)), cloud.points().zero_cost() * weight * weight);
  Splitter splitter(cloud.points(), norms, partition_by_group(all_of(cloud), {}), 1);
  EXPECT_FALSE(splitter.split_to(2));
  EXPECT_EQ(splitter.clusters(), 1u);
  EXPECT_EQ(splitter.cost(), 0.0);
}

TEST(Cost, EdgeCostsAreRowSumsOfTheDistances) {
  const PointCloud cloud = random_cloud(40, 5, 3);
  std::vector<std::uint16_t> groups(40);
  for (std::size_t j = 0; j < 40; ++j) groups[j] = j % 3 == 0;
  const auto norms = own_norms(cloud.points());
  const Partition by_group = partition_by_group(all_of(cloud), groups);
  const auto alpha = edge_costs(cloud.points(), norms, by_group);
  for (std::size_t k = 0; k < 40; ++k) {
    const std::uint32_t i = by_group.order[k];
    double expected = 0, scale = 0;
    for (std::uint32_t j = 0; j < 40; ++j)
      if (groups[i] == groups[j]) {
        expected += distance(cloud, i, j);
        scale += norms[i] * norms[j];
      }
    EXPECT_NEAR(alpha[k], expected, 1e-12 * scale);
  }
}

TEST(Cost, BestCutEqualsTheExhaustiveSearch) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const PointCloud cloud = random_cloud(30, 4, seed);
    const auto sorted = all_of(cloud);
    const auto norms = own_norms(cloud.points());
    double min_cost = INFINITY;
    for (std::size_t left = 1; left < 30; ++left) {
      const std::span<const std::uint32_t> s(sorted);
      min_cost =
          std::min(min_cost, pairwise_cost(cloud, s.first(left)) + pairwise_cost(cloud, s.subspan(left)));
    }
    const Cut cut = best_cut(cloud.points(), norms, sorted);
    EXPECT_NEAR(cut.left_cost + cut.right_cost, min_cost, 1e-12 * min_cost);
  }
}

}  // namespace
}  // namespace lumirank::linalg
