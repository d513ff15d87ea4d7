// Clusters of light-frame pairs on made-up tensors.
#include "linalg/rectangle_clustering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "base/parallel.h"
#include "base/random.h"

namespace lumirank::linalg {
namespace {

// Entry (row, light, frame).
using EntryFunction = std::function<Rgb(std::size_t, std::size_t, std::size_t)>;

ReducedTensor tensor_of(const ReducedTensor::Shape& shape, const EntryFunction& entry) {
  ReducedTensor tensor(shape);
  std::vector<Rgb> values(shape.rows * shape.columns);
  for (std::size_t k = 0; k < shape.frames; ++k) {
    for (std::size_t i = 0; i < shape.rows; ++i)
      for (std::size_t j = 0; j < shape.columns; ++j) values[i * shape.columns + j] = entry(i, j, k);
    tensor.set_frame(k, values);
  }
  return tensor;
}
ReducedTensor random_tensor(const ReducedTensor::Shape& shape, std::uint64_t seed) {
  Rng rng(seed, Stage::test);
  return tensor_of(shape, [&](std::size_t, std::size_t, std::size_t) {
    return Rgb(rng.next_float() < 0.3f ? 0.0f : rng.next_float(), rng.next_float(), rng.next_float());
  });
}
Partition all_lights(std::size_t columns) {
  Partition p;
  p.order.resize(columns);
  std::iota(p.order.begin(), p.order.end(), 0u);
  p.starts = {0, static_cast<std::uint32_t>(columns)};
  return p;
}

// By the definition, over all ordered pairs.
double brute_cost(const ReducedTensor& t, const RectangleClustering::Rectangle& r) {
  std::vector<std::pair<double, std::vector<float>>> pairs;
  for (const std::uint32_t j : r.lights)
    for (std::uint32_t k = r.begin; k < r.end; ++k) {
      std::vector<float> x(t.rows());
      t.information(j, k, x.data());
      pairs.emplace_back(t.weight(j, k), x);
    }
  double sum = 0;
  for (const auto& [w, x] : pairs)
    for (const auto& [v, y] : pairs)
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double d = static_cast<double>(x[i]) - static_cast<double>(y[i]);
        sum += w * v * d * d;
      }
  return sum;
}

TEST(ReducedTensor, KeepsNormsAndDirections) {
  for (const auto precision : {ReducedTensor::Precision::bits16, ReducedTensor::Precision::bits32}) {
    const ReducedTensor t = tensor_of({3, 2, 2, precision}, [](std::size_t i, std::size_t j, std::size_t k) {
      if (j == 1 && k == 0) return Rgb(0);
      return Rgb(static_cast<float>(i + 1), 2, 0) * static_cast<float>(1 + k);
    });
    // Rows (1, 2, 0), (2, 2, 0), (3, 2, 0): squares 14 + 12 = 26.
    EXPECT_NEAR(t.weight(0, 0), std::sqrt(26.0f), 1e-5f);
    EXPECT_NEAR(t.weight(0, 1), 2 * std::sqrt(26.0f), 1e-5f);
    EXPECT_NEAR(t.channel(0, 0, 0), std::sqrt(14.0f), 1e-5f);
    EXPECT_NEAR(t.channel(0, 0, 1), std::sqrt(12.0f), 1e-5f);
    EXPECT_EQ(t.weight(1, 0), 0);
    std::vector<float> x(3);
    t.information(0, 1, x.data());
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(x[i], std::hypot(static_cast<float>(i + 1), 2.0f) / std::sqrt(26.0f), 1e-5f);
    t.information(1, 0, x.data());
    EXPECT_EQ(x, std::vector<float>(3, 0.0f));
  }
}

TEST(RectangleClustering, CostsAreTheDefinition) {
  const ReducedTensor t = random_tensor({6, 14, 5}, 1);
  RectangleClustering c(t, all_lights(14), 1);
  for (const std::size_t count : {1u, 2u, 5u, 12u}) {
    EXPECT_TRUE(c.split_to(count));
    for (const auto& r : c.rectangles()) EXPECT_NEAR(r.cost, brute_cost(t, r), 1e-6 * (1 + r.cost)) << count;
  }
}

// Every pair of a light and a frame is in exactly one rectangle, and no split raises the cost.
TEST(RectangleClustering, PartitionsAndFalls) {
  const ReducedTensor t = random_tensor({8, 40, 9}, 2);
  Partition start = all_lights(40);
  start.starts = {0, 11, 25, 40};
  RectangleClustering c(t, start, 3);
  double before = c.cost();
  for (std::size_t count = 4; count <= 360; ++count) {
    if (!c.split_to(count)) break;
    EXPECT_LE(c.cost(), before * (1 + 1e-9)) << count;
    before = c.cost();
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::size_t all = 0;
    for (const auto& r : c.rectangles()) {
      EXPECT_LT(r.begin, r.end);
      for (const std::uint32_t j : r.lights)
        for (std::uint32_t k = r.begin; k < r.end; ++k) pairs.emplace(j, k), ++all;
    }
    ASSERT_EQ(all, 360u);
    ASSERT_EQ(pairs.size(), 360u);
  }
  EXPECT_EQ(c.cost(), 0);  // single pairs
}

// Blocks that are alike within and unlike across are found, and nothing is split beyond them. In one tensor
// the blocks are sets of lights, in one ranges of frames.
TEST(RectangleClustering, FindsTheBlocksOfATensor) {
  const std::size_t rows = 10, columns = 30, frames = 12;
  const auto block_tensor = [&](const auto& block_of) {
    Rng rng(5, Stage::test);
    std::vector<std::vector<float>> direction(12, std::vector<float>(rows));
    for (auto& d : direction)
      for (float& v : d) v = rng.next_float() + 0.01f;
    return tensor_of({rows, columns, frames}, [&](std::size_t i, std::size_t j, std::size_t k) {
      return Rgb(direction[block_of(j, k)][i]) * (1 + static_cast<float>(j % 7));
    });
  };
  const ReducedTensor by_light = block_tensor([](std::size_t j, std::size_t) { return j % 5; });
  RectangleClustering lights(by_light, all_lights(columns), 1);
  EXPECT_FALSE(lights.split_to(50));
  EXPECT_EQ(lights.rectangles().size(), 5u);
  for (const auto& r : lights.rectangles()) EXPECT_EQ(r.end - r.begin, frames);

  const ReducedTensor by_time = block_tensor([](std::size_t, std::size_t k) { return k / 4; });
  RectangleClustering times(by_time, all_lights(columns), 1);
  EXPECT_FALSE(times.split_to(50));
  EXPECT_EQ(times.rectangles().size(), 3u);
  for (const auto& r : times.rectangles()) EXPECT_EQ(r.lights.size(), columns);
}

TEST(RectangleClustering, TimeIsSplitByItsWeight) {
  const ReducedTensor t = random_tensor({8, 30, 10}, 4);
  const auto cut_in_time = [&](double weight) {
    RectangleClustering c(t, all_lights(30), 1, weight);
    c.split_to(20);
    return std::count_if(c.rectangles().begin(), c.rectangles().end(),
                         [](const auto& r) { return r.end - r.begin < 10; });
  };
  EXPECT_EQ(cut_in_time(0), 0);
  EXPECT_GT(cut_in_time(1), 0);
  EXPECT_EQ(cut_in_time(1e9), 20);
}

TEST(RectangleClustering, IsTheSameOnAnyNumberOfThreadsAndInSteps) {
  const ReducedTensor t = random_tensor({10, 200, 8}, 6);
  const auto result = [&](int threads, const std::vector<std::size_t>& steps) {
    std::vector<std::vector<std::uint32_t>> found;
    with_threads(threads, [&] {
      RectangleClustering c(t, all_lights(200), 9);
      for (const std::size_t count : steps) c.split_to(count);
      for (const auto& r : c.rectangles()) {
        found.push_back(r.lights);
        found.back().push_back(r.begin);
        found.back().push_back(r.end);
      }
    });
    return found;
  };
  const auto one = result(1, {60});
  EXPECT_EQ(one, result(3, {60}));
  EXPECT_EQ(one, result(2, {5, 31, 60}));
}

}  // namespace
}  // namespace lumirank::linalg
