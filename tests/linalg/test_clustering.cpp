#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/parallel.h"
#include "linalg/clustering.h"
#include "linalg/multiset_sampling.h"
#include "linalg/test_data.h"

namespace lumirank::linalg {
namespace {

using namespace test;

constexpr ClusteringAlgorithm kAll[] = {ClusteringAlgorithm::combined, ClusteringAlgorithm::sampling,
                                        ClusteringAlgorithm::splitting};

Partition clustered(const PointCloud& cloud, const std::vector<std::uint16_t>& groups,
                    const ClusteringSettings& s) {
  const auto norms = own_norms(cloud.points());
  return cluster(cloud.points(), norms, all_of(cloud), groups, s).partition();
}

TEST(Clustering, IsAPartition) {
  const PointCloud cloud = random_cloud(1000, 12, 1);
  for (auto algorithm : kAll) {
    const Partition p = clustered(cloud, {}, {algorithm, 40, 1});
    EXPECT_EQ(p.clusters(), 40u);
    std::vector<std::uint32_t> sorted = p.order;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, all_of(cloud));
    for (std::size_t k = 0; k < p.clusters(); ++k) EXPECT_FALSE(p.members(k).empty());
  }
}

// A cut inside a set of parallel points is never best: the cost of both sides is linear in the share on one
// side. So k directions are found exactly with k clusters, whatever the lines.
TEST(Clustering, RecoversExactDirections) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    for (auto algorithm : {ClusteringAlgorithm::combined, ClusteringAlgorithm::splitting}) {
      const std::size_t k = 17;
      const PointCloud cloud = directed_cloud(600, 20, k, seed);
      const auto norms = own_norms(cloud.points());
      const Splitter splitter = cluster(cloud.points(), norms, all_of(cloud), {}, {algorithm, k, seed});
      EXPECT_EQ(splitter.cost(), 0.0);
      const Partition p = splitter.partition();
      ASSERT_EQ(p.clusters(), k);
      for (std::size_t c = 0; c < k; ++c)
        for (std::uint32_t j : p.members(c))
          EXPECT_EQ(j % k, p.members(c)[0] % k)
              << "algorithm " << static_cast<int>(algorithm) << " seed " << seed;
    }
}

TEST(Clustering, AsManyClustersAsPointsLeavesThemAlone) {
  const PointCloud cloud = random_cloud(80, 6, 4);
  EXPECT_EQ(clustered(cloud, {}, {ClusteringAlgorithm::combined, 80, 1}).clusters(), 80u);
  EXPECT_EQ(clustered(cloud, {}, {ClusteringAlgorithm::combined, 500, 1}).clusters(), 80u);
}

TEST(Clustering, NeverCrossesGroups) {
  const PointCloud cloud = random_cloud(900, 8, 5);
  std::vector<std::uint16_t> groups(900);
  for (std::size_t j = 0; j < 900; ++j) groups[j] = static_cast<std::uint16_t>(j % 7 + (j == 3 ? 1000 : 0));
  for (auto algorithm : kAll)
    for (std::size_t count : {1u, 10u, 200u}) {
      const Partition p = clustered(cloud, groups, {algorithm, count, 1});
      EXPECT_GE(p.clusters(), 8u);  // seven residues, and point 3 in a group of its own
      for (std::size_t k = 0; k < p.clusters(); ++k)
        for (std::uint32_t j : p.members(k)) EXPECT_EQ(groups[j], groups[p.members(k)[0]]);
    }
}

TEST(Clustering, SameForAnyNumberOfThreads) {
  const PointCloud cloud = random_cloud(20000, 50, 6);
  for (auto algorithm : kAll) {
    Partition first;
    for (int threads : {1, 2, 4})
      with_threads(threads, [&] {
        const Partition p = clustered(cloud, {}, {algorithm, 150, 1});
        if (threads == 1) first = p;
        EXPECT_EQ(p.order, first.order);
        EXPECT_EQ(p.starts, first.starts);
      });
  }
}

TEST(Clustering, SplittingOnGivesTheSameAsSplittingAtOnce) {
  const PointCloud cloud = random_cloud(3000, 10, 7);
  const auto norms = own_norms(cloud.points());
  const ClusteringSettings s{ClusteringAlgorithm::splitting, 20, 1};
  Splitter in_steps = cluster(cloud.points(), norms, all_of(cloud), {}, s);
  double cost = in_steps.cost();
  for (std::size_t c = 30; c <= 100; c += 10) {
    in_steps.split_to(c);
    EXPECT_LE(in_steps.cost(),
              cost);  // a cut never costs: both sides' pairs are among the pairs of the whole
    cost = in_steps.cost();
  }
  const Partition at_once = clustered(cloud, {}, {ClusteringAlgorithm::splitting, 100, 1});
  EXPECT_EQ(in_steps.partition().starts, at_once.starts);
  for (std::size_t k = 0; k < 100; ++k) {
    std::set<std::uint32_t> a, b;
    const Partition p = in_steps.partition();
    a.insert(p.members(k).begin(), p.members(k).end());
    b.insert(at_once.members(k).begin(), at_once.members(k).end());
    EXPECT_EQ(a, b);
  }
}

TEST(MultisetSampling, DrawsInProportionToEdgeCosts) {
  const std::vector<double> alpha{1, 0, 2, 3, 4};
  // Chi-square with 3 degrees of freedom over 4000 first draws; 16.27 is exceeded with probability 0.001.
  std::vector<double> seen(5, 0.0);
  const int trials = 4000;
  for (int t = 0; t < trials; ++t)
    seen[draw_centers(alpha, 1, static_cast<std::uint64_t>(t)).position[0]] += 1;
  EXPECT_EQ(seen[1], 0);
  double chi = 0;
  for (std::size_t k : {0u, 2u, 3u, 4u}) {
    const double expected = trials * alpha[k] / 10;
    chi += (seen[k] - expected) * (seen[k] - expected) / expected;
  }
  EXPECT_LT(chi, 16.27);
}

TEST(MultisetSampling, EndsWhenCandidatesRunOut) {
  EXPECT_TRUE(draw_centers(std::vector<double>{0, 0, 0}, 2, 1).position.empty());
  const Centers all = draw_centers(std::vector<double>{0, 5, 1}, 10, 1);
  EXPECT_EQ(all.position, (std::vector<std::uint32_t>{1, 2}));
  // Every draw of k adds 1/p_k: 10 draws at least one of each, so weights are multiples of 6/5 and of 6.
  EXPECT_NEAR(std::remainder(all.weight[0], 1.2), 0, 1e-9);
  EXPECT_NEAR(std::remainder(all.weight[1], 6.0), 0, 1e-9);
}

TEST(MultisetSampling, AssignsToTheNearestWeightedCenter) {
  const PointCloud cloud = random_cloud(2000, 10, 9);
  const auto norms = own_norms(cloud.points());
  const Partition whole = partition_by_group(all_of(cloud), {});
  const Centers centers = draw_centers(edge_costs(cloud.points(), norms, whole), 300, 1);
  const auto distance = [&](std::size_t k, std::uint32_t j) {
    const std::uint32_t i = centers.position[k];
    double dot = 0;
    for (std::size_t d = 0; d < 10; ++d)
      dot += static_cast<double>(cloud[i][d]) * static_cast<double>(cloud[j][d]);
    return centers.weight[k] * (norms[i] * norms[j] - dot);
  };
  const Partition p = assign_to_centers(cloud.points(), norms, whole, centers);
  for (std::size_t c = 0; c < p.clusters(); ++c) {
    // The cluster's center is the one member that is a center.
    std::size_t own = centers.position.size();
    for (std::uint32_t j : p.members(c)) {
      const auto it = std::lower_bound(centers.position.begin(), centers.position.end(), j);
      if (it != centers.position.end() && *it == j)
        own = static_cast<std::size_t>(it - centers.position.begin());
    }
    ASSERT_LT(own, centers.position.size());
    for (std::uint32_t j : p.members(c)) {
      double min_distance = INFINITY;
      for (std::size_t k = 0; k < centers.position.size(); ++k)
        min_distance = std::min(min_distance, distance(k, j));
      // Cosines are compared in single precision (2⁻²⁴ each of ten products and of 1 − cos).
      const double rounding = 20 * 0x1p-24 * centers.weight[own] * norms[centers.position[own]] * norms[j];
      EXPECT_LE(distance(own, j), min_distance + rounding +
                                      1e-6 * centers.weight[own] * norms[centers.position[own]] * norms[j] +
                                      1.001e-4 * min_distance);
    }
  }
}

}  // namespace
}  // namespace lumirank::linalg
