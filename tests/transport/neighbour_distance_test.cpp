#include "transport/neighbour_distance.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/random.h"

namespace lumirank::transport {
namespace {

std::vector<float> brute_force(const std::vector<Vec3f>& points, int k) {
  std::vector<float> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<float> d2;
    for (std::size_t j = 0; j < points.size(); ++j)
      if (j != i) d2.push_back(length_squared(points[j] - points[i]));
    std::nth_element(d2.begin(), d2.begin() + (k - 1), d2.end());
    result.push_back(d2[static_cast<std::size_t>(k - 1)]);
  }
  return result;
}

// Equal to the last bit: both take the same differences of the same points.
TEST(NeighbourDistance, IsThatOfBruteForce) {
  for (const std::size_t n : {11u, 12u, 16u, 17u, 100u, 1500u}) {
    Rng rng(n, Stage::test);
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < n; ++i) {
      Vec3f p{rng.next_float(), rng.next_float(), rng.next_float()};
      if (i % 3 == 0) p.z = 0.5f;                  // many on a plane
      if (i % 7 == 0 && i > 0) p = points[i / 2];  // some twice
      points.push_back(p);
    }
    EXPECT_EQ(neighbour_distance_squared(points, 10), brute_force(points, 10)) << n << " points";
  }
}

TEST(NeighbourDistance, FewPoints) {
  const std::vector<Vec3f> three{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  EXPECT_EQ(neighbour_distance_squared(three, 10), (std::vector<float>{9, 4, 9}));
  EXPECT_EQ(neighbour_distance_squared(std::vector<Vec3f>{{1, 2, 3}}, 10), std::vector<float>{0});
  EXPECT_TRUE(neighbour_distance_squared({}, 10).empty());
}

TEST(NeighbourDistance, ManyEqualPoints) {
  const std::vector<Vec3f> same(500, Vec3f{1, 1, 1});
  EXPECT_EQ(neighbour_distance_squared(same, 10), std::vector<float>(500, 0.0f));
}

}  // namespace
}  // namespace lumirank::transport
