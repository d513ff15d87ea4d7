#include "base/neighbor_distance.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/random.h"

namespace lumirank {
namespace {

std::vector<float> brute_force(const std::vector<Vec3f>& points, const std::vector<std::uint32_t>& group,
                               int k) {
  std::vector<float> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<float> d2;
    for (std::size_t j = 0; j < points.size(); ++j)
      if (group.empty() ? j != i : group[j] != group[i]) d2.push_back(length_squared(points[j] - points[i]));
    std::nth_element(d2.begin(), d2.begin() + (k - 1), d2.end());
    result.push_back(d2[static_cast<std::size_t>(k - 1)]);
  }
  return result;
}

std::vector<float> distances(const std::vector<Neighbor>& found) {
  std::vector<float> result;
  for (const Neighbor& n : found) result.push_back(n.distance_squared);
  return result;
}

// Equal to the last bit: both take the same differences of the same points.
TEST(NeighborDistance, IsThatOfBruteForce) {
  for (const std::size_t n : {11u, 12u, 16u, 17u, 100u, 1500u}) {
    Rng rng(n, Stage::test);
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < n; ++i) {
      Vec3f p{rng.next_float(), rng.next_float(), rng.next_float()};
      if (i % 3 == 0) p.z = 0.5f;                  // many on a plane
      if (i % 7 == 0 && i > 0) p = points[i / 2];  // some twice
      points.push_back(p);
    }
    EXPECT_EQ(distances(neighbors(points, {}, 10)), brute_force(points, {}, 10)) << n << " points";
  }
}

// Points come in groups of up to 40: more than ten of its own lie around each.
TEST(NeighborDistance, LeavesOutTheOwnGroup) {
  Rng rng(1, Stage::test);
  std::vector<Vec3f> points;
  std::vector<std::uint32_t> group;
  for (std::uint32_t g = 0; g < 60; ++g) {
    const Vec3f middle{rng.next_float(), rng.next_float(), rng.next_float()};
    for (std::uint32_t k = 0; k <= g % 40; ++k) {
      points.push_back(middle + Vec3f{rng.next_float(), rng.next_float(), rng.next_float()} * 0.01f);
      group.push_back(g);
    }
  }
  const auto found = neighbors(points, group, 10);
  EXPECT_EQ(distances(found), brute_force(points, group, 10));
  for (const Neighbor& n : found) EXPECT_EQ(n.count, 10);
}

TEST(NeighborDistance, FewPoints) {
  const std::vector<Vec3f> three{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  const auto found = neighbors(three, {}, 10);
  EXPECT_EQ(distances(found), (std::vector<float>{9, 4, 9}));
  EXPECT_EQ(found[0].count, 2);
  const std::vector<std::uint32_t> two_groups{5, 5, 7}, one_group{5, 5, 5};
  EXPECT_EQ(distances(neighbors(three, two_groups, 10)), (std::vector<float>{9, 4, 9}));
  for (const Neighbor& n : neighbors(three, one_group, 10)) EXPECT_EQ(n.count, 0);
  EXPECT_EQ(neighbors(std::vector<Vec3f>{{1, 2, 3}}, {}, 10).at(0).count, 0);
  EXPECT_TRUE(neighbors({}, {}, 10).empty());
}

TEST(NeighborDistance, ManyEqualPoints) {
  const std::vector<Vec3f> same(500, Vec3f{1, 1, 1});
  EXPECT_EQ(distances(neighbors(same, {}, 10)), std::vector<float>(500, 0.0f));
}

}  // namespace
}  // namespace lumirank
