// Means over neighboring frames on made-up shots: what they average out, and what they leave alone.
#include "methods/tensor_clustering/temporal_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

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
  return filter_in_time({light, mappings, std::vector<matrix::RowFeatures>(light.size()),
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
  const Light mean = filtered(restless, {1, 1, 0}), calm = filtered(restless, {1, 1, 0.1});
  for (std::size_t k = 1; k + 1 < calm.size(); ++k) {
    EXPECT_NEAR(mean[k][0].r, 0.99f, 1e-6f) << k;
    EXPECT_NEAR(calm[k][0].r, 0.99f, 0.003f) << k;
  }
  // The first and the last frame have no neighbors on both sides.
  EXPECT_EQ(calm.front(), restless.front());
  EXPECT_EQ(calm.back(), restless.back());
}

TEST(TemporalFilter, LeavesAloneWhatMovesPast) {
  const Light shadow = light_of(9, [](std::size_t k) { return k == 4 || k == 5 ? 0.1 : 1.0; });
  EXPECT_EQ(filtered(shadow, {2, 1, 0.1}), shadow);
  EXPECT_NE(filtered(shadow, {1, 1, 0}), shadow);  // no bound
}

// Whatever light does, a pass changes it by less than the bound says.
TEST(TemporalFilter, KeepsItsBound) {
  const Light wild = light_of(200, [](std::size_t k) {
    const auto t = static_cast<double>(k);
    return 1 + 0.3 * std::sin(1.7 * t) + 0.05 * std::sin(5.1 * t * t);
  });
  Light before = wild;
  for (const std::size_t passes : {1u, 2u, 3u}) {
    const Light out = filtered(wild, {passes, 1, 0.1});
    std::size_t moved = 0;
    for (std::size_t k = 0; k < wild.size(); ++k) {
      EXPECT_LE(std::abs(out[k][0].r - before[k][0].r), 0.06f * before[k][0].r);
      moved += out[k] != before[k];
    }
    EXPECT_GT(moved, 20u);
    before = out;
  }
}

// A row per frame that moves over a texture: light is compared as what it would be at the row's reflectance.
TEST(TemporalFilter, DividesByReflectance) {
  const std::vector<std::vector<Rgb>> reflectance{{Rgb(0.2f)}, {Rgb(0.8f)}, {Rgb(0.4f)}};
  const Light light{{Rgb(0.2f * 1.06f)}, {Rgb(0.8f)}, {Rgb(0.4f * 1.06f)}};
  const FrameMappings mappings = rows_that_stay(3, 1);
  std::vector<matrix::RowFeatures> features(3);
  for (std::size_t k = 0; k < 3; ++k) features[k].albedo = reflectance[k];
  const Light out = filter_in_time({light, mappings, features, {0, 0, 0}}, {1, 1, 0});
  EXPECT_NEAR(out[1][0].r, 0.8f * 1.04f, 1e-6f);
}

TEST(TemporalFilter, StopsWhereAMappingDoesNotReach) {
  const Light light = light_of(5, [](std::size_t k) { return k == 2 ? 1.0 : 1.003; });
  for (const float distance : {3.0f, std::numeric_limits<float>::infinity()}) {
    FrameMappings mappings = rows_that_stay(5, 1);
    mappings.to_later[1].distance[0] = distance;  // what frame 2 shows was hidden in frame 1
    const auto filter = [&](double max_distance) {
      std::vector<matrix::RowFeatures> features(5);
      const std::vector<Vec3f> place{Vec3f{0, 0, 0}};
      for (auto& f : features) f.position = place;
      return filter_in_time({light, mappings, features, std::vector<float>(5, 0), 1.0f},
                            {1, max_distance, 0})[2][0]
          .r;
    };
    EXPECT_EQ(filter(2), 1.0f);
    if (std::isfinite(distance))
      EXPECT_NEAR(filter(0), 1.002f, 1e-6f);
    else
      EXPECT_EQ(filter(0), 1.0f);
  }
}

// A view that moves by parts of the distance of rows over a surface whose light is `of` its places: rows of
// no frame show the same ones.
class MovedView {
 public:
  static constexpr std::size_t kFrames = 6, kSide = 24;

  template <typename Of>
  explicit MovedView(const Of& of) {
    std::vector<std::unique_ptr<const FrameRows>> rows;
    for (std::size_t k = 0; k < kFrames; ++k) {
      const auto t = static_cast<float>(k);
      for (std::size_t i = 0; i < kSide * kSide; ++i) {
        const auto x = static_cast<float>(i % kSide), y = static_cast<float>(i / kSide);
        places_[k].push_back({x + 0.37f * t, y - 0.21f * t, 0});
        light[k].push_back(of(places_[k].back()));
      }
      features_[k].position = places_[k], features_[k].normal = up_;
      rows.push_back(std::make_unique<const FrameRows>(features_[k], light[k].size(), kScale));
      if (k == 0) continue;
      mappings.to_later.push_back(rows[k]->nearest(*rows[k - 1]));
      mappings.to_earlier.push_back(rows[k - 1]->nearest(*rows[k]));
    }
  }
  Light filtered(const TemporalFilter& filter) const {
    return filter_in_time({light, mappings, features_, std::vector<float>(kFrames, 0.0f), kScale}, filter);
  }
  // body(frame, row) of those around which everything is seen in the frames before and after too.
  template <typename Body>
  void inside(const Body& body) const {
    for (std::size_t k = 1; k + 1 < kFrames; ++k)
      for (std::size_t y = 3; y + 3 < kSide; ++y)
        for (std::size_t x = 3; x + 3 < kSide; ++x) body(k, y * kSide + x);
  }

  Light light = Light(kFrames);
  FrameMappings mappings;

 private:
  static constexpr float kScale = 10;
  std::vector<std::vector<Vec3f>> places_{kFrames};
  std::vector<Vec3f> up_ = std::vector<Vec3f>(kSide * kSide, Vec3f{0, 0, 1});
  std::vector<matrix::RowFeatures> features_{kFrames};
};

TEST(TemporalFilter, InterpolatesBetweenRows) {
  const MovedView view([](Vec3f at) { return Rgb(1 + 0.03f * at.x, 2 + 0.02f * at.y, 1); });
  const Light out = view.filtered({1, 10, 0});
  float worst = 0, worst_of_nearest = 0;
  view.inside([&](std::size_t k, std::size_t i) {
    worst = std::max(worst, std::abs(out[k][i].r - view.light[k][i].r));
    const Rgb nearest = view.light[k - 1][view.mappings.to_later[k - 1].from[i]];
    worst_of_nearest = std::max(worst_of_nearest, std::abs(nearest.r - view.light[k][i].r));
  });
  EXPECT_LT(worst, 0.001f);
  EXPECT_GT(worst_of_nearest, 0.01f);  // or there was nothing to interpolate
}

// Stripes as wide as the distance of rows: there is nothing to interpolate between, and they stay as sharp.
TEST(TemporalFilter, LeavesDetailAlone) {
  const MovedView view([](Vec3f at) { return Rgb(std::fmod(at.x + 100, 2.0f) < 1 ? 1.0f : 0.6f); });
  const Light sharp = view.filtered({1, 10, 0.1}), blurred = view.filtered({1, 10, 0});
  std::size_t as_they_were = 0, blurry = 0, all = 0;
  view.inside([&](std::size_t k, std::size_t i) {
    ++all;
    as_they_were += sharp[k][i] == view.light[k][i];
    blurry += std::abs(blurred[k][i].r - view.light[k][i].r) > 0.02f;
  });
  EXPECT_EQ(as_they_were, all);
  EXPECT_GT(blurry, all / 4);
}

}  // namespace
}  // namespace lumirank::methods
