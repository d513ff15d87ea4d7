// Graphs whose best partition is plain, and boundaries between sets of points.
#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "base/error.h"
#include "linalg/graph_partition.h"
#include "linalg/kernel_boundary.h"

namespace lumirank::linalg {
namespace {

// A chain of `count` cliques of `size` nodes, joined by one light edge each.
Graph cliques(std::uint32_t count, std::uint32_t size) {
  std::vector<Edge> edges;
  for (std::uint32_t c = 0; c < count; ++c) {
    for (std::uint32_t a = 0; a < size; ++a)
      for (std::uint32_t b = a + 1; b < size; ++b) edges.push_back({c * size + a, c * size + b, 100});
    if (c > 0) edges.push_back({c * size - 1, c * size, 1});
  }
  return graph_of(count * size, edges);
}

TEST(GraphPartition, CliquesStayWhole) {
  for (const std::uint32_t count : {2u, 8u}) {
    const auto part = partition_graph(cliques(count, 12), count, 1);
    std::set<std::uint32_t> seen;
    for (std::uint32_t c = 0; c < count; ++c) {
      for (std::uint32_t a = 1; a < 12; ++a) EXPECT_EQ(part[c * 12 + a], part[c * 12]);
      seen.insert(part[c * 12]);
    }
    EXPECT_EQ(seen.size(), count);
  }
}

TEST(GraphPartition, EdgesStandAtBothEndsOnce) {
  const Graph g = graph_of(3, {{0, 1, 5}, {1, 0, 7}, {2, 2, 9}});
  EXPECT_EQ(g.first, (std::vector<std::int32_t>{0, 1, 2, 2}));
  EXPECT_EQ(g.neighbor, (std::vector<std::int32_t>{1, 0}));
  EXPECT_EQ(g.weight, (std::vector<std::int32_t>{7, 7}));
}

TEST(GraphPartition, SmallAndLooseGraphsHaveParts) {
  EXPECT_TRUE(partition_graph({}, 4, 1).empty());
  EXPECT_EQ(partition_graph(graph_of(3, {}), 1, 1), (std::vector<std::uint32_t>{0, 0, 0}));
  const auto part = partition_graph(graph_of(6, {}), 3, 1);
  for (const std::uint32_t p : part) EXPECT_LT(p, 3u);
}

TEST(GraphPartition, SameBitsFromManyThreads) {
  std::vector<Edge> edges;
  for (std::uint32_t v = 0; v < 2000; ++v)
    for (std::uint32_t k = 1; k < 4; ++k)
      edges.push_back({v, (v * 37 + k * 101) % 2000, static_cast<std::int32_t>(1 + v % 7)});
  const Graph g = graph_of(2000, edges);
  const auto alone = partition_graph(g, 9, 5);
  std::vector<std::vector<std::uint32_t>> found(6);
  std::vector<std::thread> threads;
  for (auto& f : found) threads.emplace_back([&] { f = partition_graph(g, 9, 5); });
  for (auto& t : threads) t.join();
  for (const auto& f : found) EXPECT_EQ(f, alone);
}

TEST(KernelBoundary, ASphereDividesInsideFromOutside) {
  std::vector<Vec3f> points;
  std::vector<std::uint8_t> outside;
  for (int k = 0; k < 300; ++k) {
    const float z = 2 * (static_cast<float>(k) + 0.5f) / 300 - 1, phi = 2.4f * static_cast<float>(k);
    const float ring = std::sqrt(1 - z * z), radius = k % 2 == 0 ? 0.7f : 1.3f;
    points.push_back(Vec3f{ring * std::cos(phi), ring * std::sin(phi), z} * (5 * radius));
    outside.push_back(k % 2 == 1);
  }
  const KernelBoundary boundary(points, outside, 0.5);
  for (const Vec3f w : {Vec3f{1, 0, 0}, Vec3f{0, 0, -1}, normalize(Vec3f{1, 1, 1})}) {
    EXPECT_LT(boundary.side(w * 3.5f), 0);
    EXPECT_GT(boundary.side(w * 6.5f), 0);
  }
  EXPECT_THROW(KernelBoundary(points, std::vector<std::uint8_t>(300, 0), 0.5), InternalError);
}

}  // namespace
}  // namespace lumirank::linalg
