// Places along rays: their densities are those of what is drawn, and estimates with them agree with
// quadrature.
#include <gtest/gtest.h>

#include <vector>

#include "base/random.h"
#include "support/statistics.h"
#include "transport/pairs/ray_sampling.h"

namespace lumirank::transport {
namespace {

using test::expect_mean;
using test::RunningMean;

struct Pair {
  Vec3f a, along_a;
  float length_a;
  Vec3f b, along_b;
  float length_b;
};

// One of sixteen.
struct RayPlace {
  float t, pdf;
};
RayPlace on_first(const Pair& p, float u) {
  const RayPlaces all = sample_near_line(splat(p.a), splat(p.along_a), splat(p.length_a), splat(p.b),
                                         splat(p.along_b), splat(u));
  return {all.t[7], all.pdf[7]};
}
RayPlace by_angle(Vec3f origin, Vec3f along, float length, Vec3f point, float u) {
  const RayPlaces all =
      sample_equiangular(splat(origin), splat(along), splat(length), splat(point), splat(u));
  return {all.t[7], all.pdf[7]};
}

std::vector<Pair> some_pairs() {
  std::vector<Pair> pairs{
      {{0, 0, 0}, {1, 0, 0}, 2, {0.5f, -1, 0.3f}, {0, 1, 0}, 2},      // crossing at a distance
      {{0, 0, 0}, {1, 0, 0}, 2, {0, 0.5f, 0}, {1, 0, 0}, 3},          // parallel
      {{0, 0, 0}, {1, 0, 0}, 2, {5, 4, 3}, {0, 0, 1}, 1},             // far away
      {{0, 0, 0}, {1, 0, 0}, 2, {2.5f, 0.1f, 0}, {-1, 0.02f, 0}, 2},  // nearly parallel, close
  };
  for (Pair& p : pairs) p.along_a = normalize(p.along_a), p.along_b = normalize(p.along_b);
  return pairs;
}

// ∫∫ f over both rays by the midpoint rule.
template <typename F>
double quadrature(const Pair& p, F&& f) {
  constexpr int kSteps = 1500;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int k = 0; k < kSteps; ++k) {
      const float s = p.length_a * (static_cast<float>(i) + 0.5f) / kSteps;
      const float t = p.length_b * (static_cast<float>(k) + 0.5f) / kSteps;
      sum += static_cast<double>(f(p.a + p.along_a * s, p.b + p.along_b * t, s, t));
    }
  return sum * static_cast<double>(p.length_a) * static_cast<double>(p.length_b) / kSteps / kSteps;
}

// Two homogeneous media's worth of attenuation and an anisotropic factor.
float contribution(Vec3f x, Vec3f y, float s, float t) {
  const Vec3f between = y - x;
  return std::exp(-0.7f * s - 0.4f * t - 0.3f * length(between)) * (1 + 0.5f * normalize(between).x) /
         length_squared(between);
}

TEST(RaySampling, TwoRaysAgreeWithQuadrature) {
  for (const Pair& p : some_pairs()) {
    RunningMean mean;
    Rng rng(3, Stage::test);
    for (int n = 0; n < 200000; ++n) {
      const RayPlace on_a = on_first(p, rng.next_float());
      const Vec3f x = p.a + p.along_a * on_a.t;
      const RayPlace on_b = by_angle(p.b, p.along_b, p.length_b, x, rng.next_float());
      ASSERT_GT(on_a.pdf * on_b.pdf, 0);
      mean.add(static_cast<double>(contribution(x, p.b + p.along_b * on_b.t, on_a.t, on_b.t) /
                                   (on_a.pdf * on_b.pdf)));
    }
    expect_mean(mean, quadrature(p, contribution), 2e-3);
  }
}

TEST(RaySampling, APointAndARayAgreeWithQuadrature) {
  for (const Pair& p : some_pairs()) {
    const Vec3f point = p.b;
    double expected = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const float s = p.length_a * (static_cast<float>(i) + 0.5f) / kSteps;
      expected += static_cast<double>(contribution(p.a + p.along_a * s, point, s, 0));
    }
    expected *= static_cast<double>(p.length_a) / kSteps;
    RunningMean mean;
    Rng rng(5, Stage::test);
    for (int n = 0; n < 100000; ++n) {
      const RayPlace place = by_angle(p.a, p.along_a, p.length_a, point, rng.next_float());
      mean.add(static_cast<double>(contribution(p.a + p.along_a * place.t, point, place.t, 0) / place.pdf));
    }
    expect_mean(mean, expected, 1e-3);
  }
}

// In proportion to 1/d² from the second ray's origin.
float density(const Pair& p, float t) {
  const float closest = dot(p.b - p.a, p.along_a);
  const float h = std::max(length(p.b - p.a - p.along_a * closest), 1e-6f * p.length_a);
  const float angle = std::atan((p.length_a - closest) / h) - std::atan(-closest / h);
  return h / (angle * (h * h + square(t - closest)));
}

TEST(RaySampling, DensitiesIntegrateToOne) {
  for (const Pair& p : some_pairs()) {
    // The density of a place is the derivative of the number that it is drawn by.
    constexpr int kSteps = 20000;
    double near_line = 0, equiangular = 0;
    for (int k = 0; k + 1 < kSteps; ++k) {
      const float u = (static_cast<float>(k) + 0.5f) / kSteps, v = (static_cast<float>(k) + 1.5f) / kSteps;
      const RayPlace a = on_first(p, u);
      const RayPlace b = on_first(p, v);
      near_line += static_cast<double>(b.t - a.t) * 0.5 * static_cast<double>(a.pdf + b.pdf);
      const RayPlace c = by_angle(p.a, p.along_a, p.length_a, p.b, u);
      const RayPlace d = by_angle(p.a, p.along_a, p.length_a, p.b, v);
      equiangular += static_cast<double>(d.t - c.t) * 0.5 * static_cast<double>(c.pdf + d.pdf);
      // Where the ray starts tells the place on it only as well as floats hold their difference.
      EXPECT_NEAR(c.pdf, density(p, c.t), 1e-4f * c.pdf);
    }
    EXPECT_NEAR(near_line, 1, 2e-3);
    EXPECT_NEAR(equiangular, 1, 2e-3);
  }
}

TEST(RaySampling, APointOnTheRayIsNoTrouble) {
  for (const float u : {0.0f, 0.3f, 0.999999f}) {
    const RayPlace place = by_angle({0, 0, 0}, {1, 0, 0}, 2, {1, 0, 0}, u);
    EXPECT_TRUE(std::isfinite(place.t) && std::isfinite(place.pdf));
    EXPECT_GE(place.t, 0);
    EXPECT_LE(place.t, 2);
    const RayPlace crossing = on_first({{0, 0, 0}, {1, 0, 0}, 2, {1, -1, 0}, {0, 1, 0}, 2}, u);
    EXPECT_TRUE(std::isfinite(crossing.t) && std::isfinite(crossing.pdf));
  }
}

}  // namespace
}  // namespace lumirank::transport
