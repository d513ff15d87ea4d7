// Point, spot and directional light.
#include <gtest/gtest.h>

#include "base/random.h"
#include "base/warp.h"
#include "emitters/emitter.h"
#include "support/statistics.h"

namespace lumirank::emitters {
namespace {

using test::expect_mean;
using test::RunningMean;

SpotEmitter spot(float cutoff_degrees, float beam_degrees) {
  SpotEmitter s;
  s.position = {1, 2, 3};
  s.frame = Frame::from_normal(normalize(Vec3f{1, -2, 0.5f}));
  s.intensity = Rgb(1, 2, 4);
  s.cutoff = cutoff_degrees * kPi / 180, s.beam = beam_degrees * kPi / 180;
  s.cos_cutoff = std::cos(s.cutoff), s.cos_beam = std::cos(s.beam);
  return s;
}

TEST(Point, PowerEmissionAndInverseSquare) {
  const Emitter e{"", 0, PointEmitter{{1, 2, 3}, Rgb(1, 2, 4)}};
  EXPECT_FLOAT_EQ(power(e, 9).g, 4 * kPi * 2);
  const Emission s = sample_emission(e, Bounds3f{}, 0.1f, {0.2f, 0.3f}, {0.4f, 0.5f});
  EXPECT_FLOAT_EQ(s.weight.g, 4 * kPi * 2);  // every particle carries the power
  EXPECT_EQ(s.origin, (Vec3f{1, 2, 3}));
  const DirectSample d = sample_direct(e, {1, 2, 0}, 0.1f, {0.2f, 0.3f});
  EXPECT_TRUE(d.delta);
  EXPECT_FLOAT_EQ(d.pdf, 1);
  EXPECT_FLOAT_EQ(d.distance, 3);
  EXPECT_FLOAT_EQ(d.direction.z, 1);
  EXPECT_FLOAT_EQ(d.radiance.b, 4.0f / 9);
  EXPECT_EQ(sample_direct(e, {1, 2, 3}, 0.1f, {0.2f, 0.3f}).pdf, 0);  // the point itself
}

TEST(Spot, FallsOffLinearlyInAngle) {
  const SpotEmitter s = spot(40, 10);
  const auto at = [&](float degrees) {
    const float a = degrees * kPi / 180;
    return s.intensity_towards(s.frame.n * std::cos(a) + s.frame.s * std::sin(a)).r;
  };
  EXPECT_FLOAT_EQ(at(0), 1);
  EXPECT_FLOAT_EQ(at(9.9f), 1);
  EXPECT_NEAR(at(25), 0.5, 1e-5);
  EXPECT_NEAR(at(39), 1.0 / 30, 1e-4);
  EXPECT_EQ(at(40.1f), 0);
  EXPECT_EQ(at(180), 0);
}

TEST(Spot, PowerByQuadratureAndByEmission) {
  for (const SpotEmitter& s : {spot(40, 10), spot(60, 0), spot(30, 30), spot(100, 50)}) {
    const Emitter e{"", 0, s};
    // Midpoint rule for 2π ∫ I(θ) sinθ dθ.
    double sum = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double theta = (i + 0.5) / n * 3.14159265358979;
      const float c = static_cast<float>(std::cos(theta)), d = static_cast<float>(std::sin(theta));
      sum += 2 * 3.14159265358979 * s.intensity_towards(s.frame.n * c + s.frame.s * d).g * std::sin(theta) *
             (3.14159265358979 / n);
    }
    EXPECT_NEAR(power(e, 1).g / sum, 1, 2e-4);  // a step of 2·10⁻⁴ of the range may straddle the edge
    RunningMean mean;
    for (std::uint64_t i = 0; i < 40000; ++i) {
      Rng rng(6, Stage::test, i);
      mean.add(sample_emission(e, Bounds3f{}, 0, {0, 0}, rng.next_2d()).weight.g);
    }
    expect_mean(mean, power(e, 1).g, 1e-4);
  }
}

Bounds3f unit_scene() {
  Bounds3f b;
  b.extend(Vec3f{-1, -2, -3});
  b.extend(Vec3f{3, 2, 1});
  return b;
}

TEST(Directional, FillsTheDiscOfTheScene) {
  const Vec3f direction = normalize(Vec3f{1, -3, 2});
  const Emitter e{"", 0, DirectionalEmitter{direction, Rgb(2), 1}};
  const Bounds3f scene = unit_scene();
  const float r = scene.radius();
  EXPECT_FLOAT_EQ(power(e, r).r, 2 * kPi * r * r);
  for (std::uint64_t i = 0; i < 100; ++i) {
    Rng rng(7, Stage::test, i);
    const Emission s = sample_emission(e, scene, 0, rng.next_2d(), rng.next_2d());
    EXPECT_EQ(s.direction, direction);
    EXPECT_FLOAT_EQ(s.weight.r, 2 * kPi * r * r);
    const Vec3f from_center = s.origin - scene.center();
    EXPECT_NEAR(dot(from_center, direction), -r, 1e-5 * r);
    EXPECT_LE(length_squared(from_center), 2 * r * r * 1.0001f);
  }
  const DirectSample d = sample_direct(e, {0, 0, 0}, 0, {0.3f, 0.6f});
  EXPECT_EQ(d.direction, -direction);
  EXPECT_TRUE(std::isinf(d.distance));
  EXPECT_FLOAT_EQ(d.radiance.r, 2);
}

TEST(Directional, ADiscGivesItsIrradianceToAFacingSurface) {
  const float alpha = 0.3f;  // a huge sun, so that the cosine matters
  const Vec3f direction = normalize(Vec3f{1, -3, 2});
  const Emitter e{"", 0, DirectionalEmitter{direction, Rgb(2), std::cos(alpha)}};
  RunningMean facing, power_mean;
  for (std::uint64_t i = 0; i < 40000; ++i) {
    Rng rng(8, Stage::test, i);
    const DirectSample s = sample_direct(e, {0, 0, 0}, 0, rng.next_2d());
    ASSERT_GE(dot(s.direction, -direction), std::cos(alpha) - 1e-6f);
    facing.add(s.radiance.r * dot(s.direction, -direction) / s.pdf);
    power_mean.add(sample_emission(e, unit_scene(), 0, rng.next_2d(), rng.next_2d()).weight.r);
  }
  expect_mean(facing, 2);
  expect_mean(power_mean, power(e, unit_scene().radius()).r);
}

}  // namespace
}  // namespace lumirank::emitters
