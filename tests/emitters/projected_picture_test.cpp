// Point lights that throw a picture: value, density and sample agree.
#include "emitters/projected_picture.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "support/statistics.h"

namespace lumirank::emitters {
namespace {

using test::RunningMean;

// On the plane at distance 1.
Vec3f towards(float x, float y) { return normalize(Vec3f{x, y, 1}); }

// Random colors, some of them black, in a frame of another shape.
ProjectedPicture colors(std::uint64_t seed) {
  std::vector<Rgb> values;
  for (std::uint64_t k = 0; k < 7 * 5; ++k) {
    Rng rng(seed, Stage::test, k);
    const float dark = rng.next_float() < 0.3f ? 0 : 1;
    values.push_back(dark * Rgb(rng.next_float(), 3 * rng.next_float(), rng.next_float()));
  }
  return {7, 5, std::move(values), {1.3f, 0.6f}};
}

TEST(ProjectedPicture, BilinearWithinItsFrameAndBlackBeyond) {
  const ProjectedPicture p(2, 2, {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {4, 4, 4}}, {1, 0.5f});
  // Centers of pixels, the first at the least x and y; then the middle of all, and corners.
  const auto expect = [&](Vec2f at, Rgb color) {
    const Rgb found = p.intensity(towards(at.x, at.y));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], color[c], 1e-5f) << at.x << ' ' << at.y;
  };
  expect({-0.5f, -0.25f}, {1, 0, 0}), expect({0.5f, -0.25f}, {0, 2, 0});
  expect({-0.5f, 0.25f}, {0, 0, 3}), expect({0.5f, 0.25f}, {4, 4, 4});
  expect({0, 0}, {1.25f, 1.5f, 1.75f});
  expect({0.99f, 0.49f}, {4, 4, 4}), expect({-0.99f, -0.49f}, {1, 0, 0});
  expect({1.01f, 0}, Rgb(0)), expect({0, -0.51f}, Rgb(0));
  EXPECT_TRUE(is_black(p.intensity({0, 0, -1})));
  EXPECT_TRUE(is_black(p.intensity({1, 0, 0})));
  EXPECT_EQ(p.max_value(), 4);
  EXPECT_NEAR(p.max_theta(), std::atan(std::sqrt(1.25f)), 1e-6f);
}

// A square of half width tan α, α = 45°, has the solid angle of a side of a cube, 4π/6.
TEST(ProjectedPicture, AnEvenSquareEmitsItsSolidAngle) {
  const ProjectedPicture p(300, 300, std::vector<Rgb>(90000, {1, 2, 3}), {1, 1});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(p.total()[c] / (4 * kPi / 6 * static_cast<float>(c + 1)), 1, 1e-4f);
}

TEST(ProjectedPicture, SamplesFindAllItsLightWithTheDensityThatPdfStates) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const ProjectedPicture p = colors(seed);
    // By quadrature on the plane: dω = cos³θ dA.
    constexpr int kSteps = 800;
    double expected[3] = {0, 0, 0}, density = 0;
    for (int y = 0; y < kSteps; ++y)
      for (int x = 0; x < kSteps; ++x) {
        const Vec3f w = towards(1.3f * (2 * (static_cast<float>(x) + 0.5f) / kSteps - 1),
                                0.6f * (2 * (static_cast<float>(y) + 0.5f) / kSteps - 1));
        const double part = 4 * 1.3 * 0.6 / kSteps / kSteps * std::pow(static_cast<double>(w.z), 3);
        const Rgb light = p.intensity(w);
        for (int c = 0; c < 3; ++c) expected[c] += static_cast<double>(light[c]) * part;
        density += static_cast<double>(p.pdf(w)) * part;
      }
    EXPECT_NEAR(density, 1, 2e-3);
    RunningMean sums[3];
    for (std::uint64_t i = 0; i < 40000; ++i) {
      Rng rng(7 + seed, Stage::test, i);
      const auto s = p.sample(rng.next_2d());
      ASSERT_GT(s.pdf, 0);
      ASSERT_EQ(s.pdf, p.pdf(s.local));
      for (int c = 0; c < 3; ++c) sums[c].add(static_cast<double>(p.intensity(s.local)[c] / s.pdf));
    }
    for (int c = 0; c < 3; ++c) test::expect_mean(sums[c], expected[c], 1e-3);
  }
}

TEST(ProjectedPicture, ABlackOneEmitsNothing) {
  const ProjectedPicture p(3, 1, std::vector<Rgb>(3), {1, 1});
  EXPECT_EQ(p.sample({0.5f, 0.5f}).pdf, 0);
  EXPECT_EQ(p.pdf({0, 0, 1}), 0);
  EXPECT_TRUE(is_black(p.total()));
}

TEST(ProjectedPicture, RefusesWhatIsNoPicture) {
  EXPECT_THROW(ProjectedPicture(2, 1, {Rgb(1)}, {1, 1}), InternalError);
  EXPECT_THROW(ProjectedPicture(1, 1, {Rgb(-1)}, {1, 1}), InternalError);
  EXPECT_THROW(ProjectedPicture(1, 1, {Rgb(1)}, {0, 1}), InternalError);
}

}  // namespace
}  // namespace lumirank::emitters
