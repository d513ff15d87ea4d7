#include "emitters/area.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/warp.h"
#include "support/statistics.h"

namespace lumirank::emitters {
namespace {

using test::expect_mean;
using test::RunningMean;

AreaEmitter::Triangle triangle(Vec3f a, Vec3f b, Vec3f c, Rgb radiance) {
  AreaEmitter::Triangle t;
  t.p0 = a, t.e1 = b - a, t.e2 = c - a;
  const Vec3f n = cross(t.e1, t.e2);
  t.area = 0.5f * length(n);
  t.normal = t.area > 0 ? normalize(n) : Vec3f{};
  t.mean_radiance = radiance;
  return t;
}

// A disc of radius r in the plane z = height that shines downwards, as a fan of n triangles.
AreaEmitter disc(float r, float height, Rgb radiance, int n = 1024) {
  AreaEmitter e;
  const auto rim = [&](int k) {
    const float phi = 2 * kPi * static_cast<float>(k % n) / static_cast<float>(n);
    return Vec3f{r * std::cos(phi), r * std::sin(phi), height};
  };
  for (int k = 0; k < n; ++k) e.triangles.push_back(triangle({0, 0, height}, rim(k + 1), rim(k), radiance));
  finish(e);
  return e;
}

// Two unit triangles of different radiance, one of no area and a black one.
AreaEmitter uneven() {
  AreaEmitter e;
  e.triangles = {triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Rgb(1, 2, 3)),
                 triangle({0, 0, 0}, {0, 0, 0}, {0, 1, 0}, Rgb(5)),
                 triangle({3, 0, 0}, {5, 0, 0}, {3, 1, 1}, Rgb(4, 0.5f, 0)),
                 triangle({7, 0, 0}, {8, 0, 0}, {7, 1, 0}, Rgb(0))};
  finish(e);
  return e;
}

TEST(Area, PowerIsPiTimesAreaTimesRadiance) {
  // Φ = π Σ A L: areas 1/2, 0, |(2,0,0)×(0,1,1)|/2 = √2, 1/2 (black).
  const Rgb p = power({"", 0, uneven()}, 1);
  const float root2 = std::sqrt(2.0f);
  EXPECT_FLOAT_EQ(p.r, kPi * (0.5f * 1 + root2 * 4));
  EXPECT_FLOAT_EQ(p.g, kPi * (0.5f * 2 + root2 * 0.5f));
  EXPECT_FLOAT_EQ(p.b, kPi * 0.5f * 3);
}

TEST(Area, EmissionWeightsAverageToThePowerAndLeaveTheBrightSide) {
  const Emitter e{"", 0, uneven()};
  const Rgb expected = power(e, 1);
  RunningMean mean[3];
  for (std::uint64_t i = 0; i < 40000; ++i) {
    Rng rng(1, Stage::test, i);
    const float u1 = rng.next_float();
    const Vec2f up = rng.next_2d(), ud = rng.next_2d();
    const Emission s = sample_emission(e, Bounds3f{}, u1, up, ud);
    ASSERT_GT(dot(s.direction, s.normal), 0);
    ASSERT_NE(s.triangle, 1u) << "a triangle without area";
    for (int k = 0; k < 3; ++k) mean[k].add(s.weight[k]);
  }
  for (int k = 0; k < 3; ++k) expect_mean(mean[k], expected[k]);
}

TEST(Area, EmittedDirectionsAreDistributedAsTheCosine) {
  // The mean of cosθ under the density cosθ/π is 2/3.
  const Emitter e{"", 0, disc(1, 0, Rgb(1))};
  RunningMean cosine;
  for (std::uint64_t i = 0; i < 40000; ++i) {
    Rng rng(2, Stage::test, i);
    const float u1 = rng.next_float();
    const Vec2f up = rng.next_2d(), ud = rng.next_2d();
    cosine.add(-sample_emission(e, Bounds3f{}, u1, up, ud).direction.z);
  }
  expect_mean(cosine, 2.0 / 3);
}

// Irradiance at the origin of a surface facing +z.
RunningMean irradiance(const Emitter& e, std::uint64_t seed, int n = 40000) {
  RunningMean mean;
  for (int i = 0; i < n; ++i) {
    Rng rng(seed, Stage::test, static_cast<std::uint64_t>(i));
    const float u1 = rng.next_float();
    const DirectSample s = sample_direct(e, {0, 0, 0}, u1, rng.next_2d());
    mean.add(s.pdf > 0 ? s.radiance.g * std::max(0.0f, s.direction.z) / s.pdf : 0.0);
  }
  return mean;
}

TEST(Area, DiscAboveAPoint) {
  // E = π L r²/(r² + d²); the 1024-gon lacks (2π/1024)²/6 = 6·10⁻⁶ of the area.
  for (const float r : {0.2f, 1.0f, 4.0f}) {
    const Emitter e{"", 0, disc(r, 1.5f, Rgb(3))};
    expect_mean(irradiance(e, 3), kPi * 3 * r * r / (r * r + 1.5 * 1.5), 3e-5);
  }
}

TEST(Area, RectangleAboveAPoint) {
  // A parallel rectangle a × b at the height h with a corner above the point (the configuration factor of
  // Hamilton and Morgan): E = L/2 [ a/√(a²+h²) atan(b/√(a²+h²)) + b/√(b²+h²) atan(a/√(b²+h²)) ].
  const double a = 2, b = 1, h = 0.75;
  AreaEmitter e;
  e.triangles = {triangle({0, 0, 0.75f}, {2, 1, 0.75f}, {2, 0, 0.75f}, Rgb(1)),
                 triangle({0, 0, 0.75f}, {0, 1, 0.75f}, {2, 1, 0.75f}, Rgb(1))};
  finish(e);
  const double x = std::hypot(a, h), y = std::hypot(b, h);
  const double expected = 0.5 * (a / x * std::atan(b / x) + b / y * std::atan(a / y));
  expect_mean(irradiance({"", 0, e}, 4), expected);
}

TEST(Area, TheDarkSideGivesNothing) {
  AreaEmitter up;
  up.triangles = {triangle({0, 0, 1}, {1, 0, 1}, {0, 1, 1}, Rgb(1))};  // normal +z, away from the origin
  finish(up);
  EXPECT_EQ(sample_direct({"", 0, up}, {0, 0, 0}, 0.5f, {0.5f, 0.5f}).pdf, 0);
  EXPECT_EQ(pdf_direct_area(up, up.triangles[0], {0, 0, 1}, 1), 0);
}

TEST(Area, DensityOfAHitAgreesWithTheSample) {
  const AreaEmitter area = uneven();
  const Emitter e{"", 0, area};
  const auto& stored = std::get<AreaEmitter>(e.kind);
  for (std::uint64_t i = 0; i < 200; ++i) {
    Rng rng(5, Stage::test, i);
    const Vec3f from{rng.next_float() * 4, rng.next_float(), 3};
    const float u1 = rng.next_float();
    const DirectSample s = sample_direct(e, from, u1, rng.next_2d());
    if (!(s.pdf > 0)) continue;
    const float pdf = pdf_direct_area(stored, stored.triangles[s.triangle], s.direction, s.distance);
    EXPECT_NEAR(pdf / s.pdf, 1, 1e-5);  // both are a handful of float operations
  }
}

TEST(Area, ABlackEmitterIsNeverSampled) {
  AreaEmitter e;
  e.triangles = {triangle({0, 0, 1}, {0, 1, 1}, {1, 0, 1}, Rgb(0))};
  finish(e);
  EXPECT_EQ(sample_direct({"", 0, e}, {0, 0, 0}, 0.5f, {0.5f, 0.5f}).pdf, 0);
  EXPECT_TRUE(is_black(sample_emission({"", 0, e}, Bounds3f{}, 0.5f, {0.5f, 0.5f}, {0.5f, 0.5f}).weight));
}

}  // namespace
}  // namespace lumirank::emitters
