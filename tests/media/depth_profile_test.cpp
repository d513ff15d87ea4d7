// Optical depths by steps, against quadrature.
#include "media/depth_profile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace lumirank::media {
namespace {

// Smoke with holes in a box that is turned and stretched.
Medium uneven_smoke() {
  std::vector<float> values(3 * 13 * 9 * 17);
  Rng rng(7, Stage::test);
  for (float& v : values) v = std::max(0.0f, 2 * rng.next_float() - 0.6f);
  const Transform box =
      Transform::rotate(1, 2, 3, 40) * Transform::scale(2, 1, 1.5) * Transform::translate(-0.5, -0.5, -0.5);
  const Field extinction{
      {1.5f, 1, 3},
      std::make_shared<const Grid>(std::array{13, 9, 17}, 3, std::move(values), Grid::Sampling::centers),
      *box.inverse(),
      true};
  return {Medium::Form::extinction_and_albedo, extinction, Field{{0.9f, 0.8f, 0.5f}}, Field{},
          PhaseFunction{}};
}

TEST(DepthProfile, AgreesWithQuadrature) {
  const Medium medium = uneven_smoke();
  Rng rng(5, Stage::test);
  for (int line = 0; line < 12; ++line) {
    const Vec3f from{rng.next_float() * 3 - 1.5f, rng.next_float() * 3 - 1.5f, -2};
    const Vec3f direction = normalize(Vec3f{rng.next_float() - 0.5f, rng.next_float() - 0.5f, 1});
    DepthProfile profile;
    profile.follow(medium, from, direction, line % 2 ? 5.0f : kInfinity);
    constexpr int kSteps = 40000;
    constexpr float kEnd = 5;
    double depth[3] = {};
    for (int k = 0; k < kSteps; ++k) {
      const float t = kEnd * (static_cast<float>(k) + 0.5f) / kSteps;
      const Rgb extinction = medium.extinction(from + direction * t);
      for (int c = 0; c < 3; ++c) depth[c] += static_cast<double>(extinction[c] * (kEnd / kSteps));
      if (k % 4000 != 3999) continue;
      const Rgb found = profile.depth(kEnd * static_cast<float>(k + 1) / kSteps);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(found[c]), depth[c], 0.02 * depth[c] + 5e-3) << line << ' ' << k;
    }
  }
}

TEST(DepthProfile, PlacesAreWhereTheDepthIs) {
  const Medium medium = uneven_smoke();
  DepthProfile profile;
  profile.follow(medium, {0.1f, -0.2f, -2}, {0, 0, 1}, 4);
  const Rgb whole = profile.whole_depth();
  ASSERT_GT(whole.r, 0.1f);
  for (int k = 1; k < 20; ++k) {
    for (int c = 0; c < 3; ++c) {
      const float depth = whole[c] * static_cast<float>(k) / 20, t = profile.place_of(depth, c);
      EXPECT_NEAR(profile.depth(t)[c], depth, 1e-5f * whole[c]);
      EXPECT_GT(profile.extinction(t)[c], 0);
    }
    const float depth = mean(whole) * static_cast<float>(k) / 20;
    EXPECT_NEAR(mean(profile.depth(profile.place_of_mean(depth))), depth, 1e-5f * mean(whole));
  }
  EXPECT_EQ(profile.place_of(whole.g * 1.01f, 1), kInfinity);
}

TEST(DepthProfile, IsExactInAHomogeneousMedium) {
  const Medium medium(Medium::Form::absorption_and_scattering, Field{{0.5f, 0, 2}}, Field{{0.25f, 0, 1}},
                      Field{}, {});
  DepthProfile profile;
  profile.follow(medium, {1, 2, 3}, {0, 1, 0}, kInfinity);
  EXPECT_EQ(profile.depth(2), (Rgb{1.5f, 0, 6}));
  EXPECT_EQ(profile.extinction(7), (Rgb{0.75f, 0, 3}));
  EXPECT_FLOAT_EQ(profile.place_of(1.5f, 0), 2);
  EXPECT_EQ(profile.place_of(0.1f, 1), kInfinity);
  EXPECT_EQ(profile.whole_depth(), (Rgb{kInfinity, 0, kInfinity}));
  profile.follow(Medium(Medium::Form::extinction_and_albedo, Field{}, Field{}, Field{}, {}), {}, {0, 0, 1},
                 3);
  EXPECT_EQ(profile.depth(3), Rgb(0));
  EXPECT_EQ(profile.place_of(0, 0), kInfinity);
}

}  // namespace
}  // namespace lumirank::media
