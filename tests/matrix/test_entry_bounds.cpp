#include <gtest/gtest.h>

#include <cmath>

#include "base/frame.h"
#include "base/random.h"
#include "base/warp.h"
#include "matrix/entry_bounds.h"

namespace lumirank::matrix {
namespace {

// Precise for nearly equal vectors, which need not be quite unit.
double angle(Vec3f a, Vec3f b) {
  const double x = a.x, y = a.y, z = a.z, u = b.x, v = b.y, w = b.z;
  return std::atan2(std::hypot(y * w - z * v, z * u - x * w, x * v - y * u), x * u + y * v + z * w);
}

// The cosine with the axis of the direction in `cone` that is furthest from `axis`.
double furthest(const Cone& cone, Vec3f axis) {
  const double between = angle(cone.axis, axis);
  const double spread = std::acos(std::clamp(static_cast<double>(cone.cosine), -1.0, 1.0));
  return std::cos(std::min(3.14159265358979, between + spread));
}

TEST(Cones, JoinedHoldBoth) {
  Rng rng(1, Stage::test);
  for (int i = 0; i < 200000; ++i) {
    const auto random_cone = [&] {
      const float spread = kPi * std::pow(10.0f, -5 * rng.next_float());
      return Cone{normalize(warp_sphere(rng.next_2d())), rng.next_float() < 0.3f ? 1.0f : std::cos(spread)};
    };
    Cone a = random_cone(), b = random_cone();
    if (i % 3 == 0) b.axis = normalize(a.axis + b.axis * std::pow(10.0f, -8 * rng.next_float()));
    if (i % 100 == 1) b.axis = -a.axis;
    const Cone both = join(a, b);
    ASSERT_NEAR(length(both.axis), 1, 1e-6);
    if (both.cosine <= -1) continue;
    // Cosines of unit vectors in floats are good to 2e-7.
    ASSERT_GE(furthest(a, both.axis), both.cosine - 2e-7) << i;
    ASSERT_GE(furthest(b, both.axis), both.cosine - 2e-7) << i;
    // No wider than needed: half of both spreads and the angle between the axes, unless one holds the other.
    const double spread_a = std::acos(static_cast<double>(a.cosine)),
                 spread_b = std::acos(static_cast<double>(b.cosine));
    const double between = angle(a.axis, b.axis);
    const double min_spread = std::max({0.5 * (spread_a + spread_b + between), spread_a, spread_b});
    ASSERT_GE(both.cosine, std::cos(min_spread) - 1e-6) << i;
  }
}

// Many joins one after the other cost little more than their roundings.
TEST(Cones, ManyJoinsStayTight) {
  Rng rng(2, Stage::test);
  const Frame frame = Frame::from_normal(normalize(Vec3f{1, 2, 3}));
  for (const float spread : {0.0f, 0.01f, 0.5f}) {
    Cone all;
    for (int k = 0; k < 1000; ++k) {
      const float theta = spread * rng.next_float(), phi = 2 * kPi * rng.next_float();
      const Cone one{
          frame.to_world({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}),
          1};
      all = k == 0 ? one : join(all, one);
    }
    // One after the other is the worst order: the cone need not end up about the middle.
    EXPECT_LE(std::acos(all.cosine), 1.5f * spread + 1e-3f) << spread;
  }
}

TEST(ColumnSets, JoinedAddUp) {
  ColumnSet a, b;
  a.box.extend(Vec3f{0, 0, 0}), b.box.extend(Vec3f{1, 2, 3});
  a.intensity = Rgb(1, 2, 3), b.intensity = Rgb(4, 5, 6), a.ceiling = Rgb(1), b.ceiling = Rgb(2);
  a.radius = a.min_radius = 1, b.radius = b.min_radius = 3, a.direct = true;
  const ColumnSet both = join(a, b);
  EXPECT_EQ(both.intensity, Rgb(5, 7, 9));
  EXPECT_EQ(both.ceiling, Rgb(3));
  EXPECT_EQ(both.box.hi, (Vec3f{1, 2, 3}));
  EXPECT_EQ(both.radius, 3);
  EXPECT_EQ(both.min_radius, 1);
  EXPECT_FALSE(both.direct);
}

}  // namespace
}  // namespace lumirank::matrix
