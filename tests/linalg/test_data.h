// Points for the tests of the clustering.
#pragma once

#include <vector>

#include "base/random.h"
#include "linalg/points.h"

namespace lumirank::linalg::test {

struct PointCloud {
  std::size_t dimension;
  std::vector<float> values;
  std::span<const float> operator[](std::size_t j) const {
    return {values.data() + j * dimension, dimension};
  }
  Points points() const { return {values.data(), values.size() / dimension, dimension}; }
};

// Positive coordinates, lengths over two decades.
inline PointCloud random_cloud(std::size_t count, std::size_t dimension, std::uint64_t seed) {
  PointCloud cloud{dimension, std::vector<float>(count * dimension)};
  for (std::size_t j = 0; j < count; ++j) {
    Rng rng(seed, Stage::test, 10, j);
    const float length = std::pow(100.0f, rng.next_float());
    for (std::size_t d = 0; d < dimension; ++d) {
      const float v = rng.next_float();
      cloud.values[j * dimension + d] = length * v * v * v;
    }
  }
  return cloud;
}

// Point j is a multiple of direction j mod directions.
inline PointCloud directed_cloud(std::size_t count, std::size_t dimension, std::size_t directions,
                                 std::uint64_t seed) {
  PointCloud cloud{dimension, std::vector<float>(count * dimension)};
  for (std::size_t j = 0; j < count; ++j) {
    Rng direction(seed, Stage::test, 11, j % directions);
    Rng rng(seed, Stage::test, 12, j);
    const float length = std::pow(100.0f, rng.next_float());
    for (std::size_t d = 0; d < dimension; ++d)
      cloud.values[j * dimension + d] = length * direction.next_float();
  }
  return cloud;
}

inline std::vector<std::uint32_t> all_of(const PointCloud& cloud) {
  std::vector<std::uint32_t> all(cloud.values.size() / cloud.dimension);
  for (std::uint32_t j = 0; j < all.size(); ++j) all[j] = j;
  return all;
}

}  // namespace lumirank::linalg::test
