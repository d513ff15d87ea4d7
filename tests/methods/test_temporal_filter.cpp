// Means over neighboring frames on made-up shots: what they average out, and what they leave alone.
#include "methods/tensor_clustering/temporal_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lumirank::methods {
namespace {

using Light = std::vector<std::vector<Rgb>>;

FrameMappings rows_that_stay(std::size_t frames, std::size_t rows) {
  FrameMappings mappings;
  mappings.to_later.assign(frames - 1, RowMapping::identity(rows));
  mappings.to_earlier = mappings.to_later;
  return mappings;
}

// One row whose light is `of` each frame.
template <typename Of>
Light light_of(std::size_t frames, const Of& of) {
  Light light;
  for (std::size_t k = 0; k < frames; ++k) light.push_back({Rgb(static_cast<float>(of(k)))});
  return light;
}

Light filtered(const Light& light, const TemporalFilter& filter) {
  const FrameMappings mappings = rows_that_stay(light.size(), light[0].size());
  return filter_in_time({light, mappings, std::vector<std::span<const Rgb>>(light.size()),
                         std::vector<float>(light.size(), 0.0f)},
                        filter);
}

TEST(TemporalFilter, LeavesAloneWhatStaysOrChangesEvenly) {
  const Light same = light_of(7, [](std::size_t) { return 0.1; });
  EXPECT_EQ(filtered(same, {3, 1, 0.1}), same);  // to the bit
  const Light even = light_of(9, [](std::size_t k) { return 1 + 0.5 * static_cast<double>(k); });
  const Light kept = filtered(even, {3, 1, 0.1});
  for (std::size_t k = 0; k < even.size(); ++k) EXPECT_NEAR(kept[k][0].r, even[k][0].r, 1e-6f) << k;
}

TEST(TemporalFilter, AveragesWhatGoesUpAndDown) {
  const Light restless = light_of(9, [](std::size_t k) {
    return k % 3 == 0 ? 1.02 : k % 3 == 1 ? 0.99 : 0.96;
  });
  const Light calm = filtered(restless, {1, 1, 0.1});
  for (std::size_t k = 1; k + 1 < calm.size(); ++k) EXPECT_NEAR(calm[k][0].r, 0.99f, 1e-6f) << k;
  // The first and the last frame have no neighbors on both sides.
  EXPECT_EQ(calm.front(), restless.front());
  EXPECT_EQ(calm.back(), restless.back());
}

TEST(TemporalFilter, LeavesAloneWhatMovesPast) {
  const Light shadow = light_of(9, [](std::size_t k) { return k == 4 || k == 5 ? 0.1 : 1.0; });
  EXPECT_EQ(filtered(shadow, {2, 1, 0.1}), shadow);
  EXPECT_NE(filtered(shadow, {2, 1, 0}), shadow);  // no bound
}

// Whatever light does, it is off by less than the bound.
TEST(TemporalFilter, KeepsItsBound) {
  const Light wild = light_of(200, [](std::size_t k) {
    const auto t = static_cast<double>(k);
    return 1 + 0.3 * std::sin(1.7 * t) + 0.05 * std::sin(5.1 * t * t);
  });
  for (const std::size_t radius : {1u, 2u, 5u}) {
    const Light out = filtered(wild, {radius, 1, 0.1});
    std::size_t moved = 0;
    for (std::size_t k = 0; k < wild.size(); ++k) {
      EXPECT_LE(std::abs(out[k][0].r - wild[k][0].r), 0.1f * wild[k][0].r);
      moved += out[k] != wild[k];
    }
    EXPECT_GT(moved, 20u);
  }
}

// A row per frame that moves over a texture: light is compared as what it would be at the row's reflectance.
TEST(TemporalFilter, DividesByReflectance) {
  const std::vector<std::vector<Rgb>> reflectance{{Rgb(0.2f)}, {Rgb(0.8f)}, {Rgb(0.4f)}};
  const Light light{{Rgb(0.2f * 1.06f)}, {Rgb(0.8f)}, {Rgb(0.4f * 1.06f)}};
  const FrameMappings mappings = rows_that_stay(3, 1);
  const Light out = filter_in_time(
      {light, mappings, {reflectance[0], reflectance[1], reflectance[2]}, {0, 0, 0}}, {1, 1, 0.1});
  EXPECT_NEAR(out[1][0].r, 0.8f * 1.04f, 1e-6f);
}

TEST(TemporalFilter, StopsWhereAMappingDoesNotReach) {
  const Light light = light_of(5, [](std::size_t k) { return k == 2 ? 1.0 : 1.03; });
  for (const float distance : {3.0f, std::numeric_limits<float>::infinity()}) {
    FrameMappings mappings = rows_that_stay(5, 1);
    mappings.to_later[1].distance[0] = distance;  // what frame 2 shows was hidden in frame 1
    const auto filter = [&](double max_distance) {
      return filter_in_time({light, mappings, std::vector<std::span<const Rgb>>(5), std::vector<float>(5, 0)},
                            {1, max_distance, 0.1})[2][0]
          .r;
    };
    EXPECT_EQ(filter(2), 1.0f);
    if (std::isfinite(distance))
      EXPECT_NEAR(filter(0), 1.02f, 1e-6f);
    else
      EXPECT_EQ(filter(0), 1.0f);
  }
}

}  // namespace
}  // namespace lumirank::methods
