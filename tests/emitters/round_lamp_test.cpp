// Round lamps: which meshes are taken for them, and the cones by which they are drawn.
#include "emitters/round_lamp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/random.h"
#include "emitters/area.h"

namespace lumirank::emitters {
namespace {

// A ball of 16 rings, each corner moved by a function; `turned`: what shines looks inwards.
AreaEmitter ball(const std::function<Vec3f(Vec3f)>& moved, bool turned = false) {
  constexpr int kRings = 16, kSegments = 32;
  AreaEmitter lamp;
  const auto at = [&](int ring, int segment) {
    const double theta = kPiD * ring / kRings, phi = 2 * kPiD * (segment % kSegments) / kSegments;
    const double rho = ring == 0 || ring == kRings ? 0 : std::sin(theta);
    return moved({static_cast<float>(rho * std::cos(phi)), static_cast<float>(rho * std::sin(phi)),
                  static_cast<float>(std::cos(theta))});
  };
  const auto add = [&](Vec3f a, Vec3f b, Vec3f c) {
    AreaEmitter::Triangle t;
    t.p0 = a, t.e1 = b - a, t.e2 = c - a;
    const Vec3f twice = cross(t.e1, t.e2);
    t.area = 0.5f * length(twice);
    if (t.area > 0) t.normal = normalize(turned ? -twice : twice);
    t.mean_radiance = Rgb(3, 2, 1);
    lamp.triangles.push_back(t);
  };
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSegments; ++j) {
      add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  finish(lamp);
  return lamp;
}
Vec3f placed(Vec3f p) { return p * 0.2f + Vec3f{100, -3, 7}; }

TEST(RoundLamp, IsABallOrWhatIsNearlyOne) {
  const auto found = round_lamp(ball(placed));
  ASSERT_TRUE(found);
  EXPECT_NEAR(length(found->center - Vec3f{100, -3, 7}), 0, 1e-4);
  EXPECT_NEAR(found->radius, 0.2f, 1e-4);
  EXPECT_TRUE(round_lamp(ball([](Vec3f p) { return Vec3f{p.x, p.y, 0.7f * p.z}; })));
  EXPECT_TRUE(round_lamp(ball([](Vec3f p) { return Vec3f{1e-3f * p.x, 1.2e-3f * p.y, 1e-3f * p.z}; })));
}

TEST(RoundLamp, IsNotWhatIsLongOpenHollowDentedOrLitInside) {
  EXPECT_FALSE(round_lamp(ball([](Vec3f p) { return Vec3f{p.x, p.y, 3 * p.z}; })));
  EXPECT_FALSE(round_lamp(ball([](Vec3f p) { return Vec3f{p.x, p.y, 0.2f * p.z}; })));
  EXPECT_FALSE(round_lamp(ball(placed, true)));
  EXPECT_FALSE(round_lamp(ball([](Vec3f p) { return p.z > 0.99f ? p * 0.8f : p; })));
  AreaEmitter open = ball(placed);
  open.triangles.resize(open.triangles.size() - 64);
  finish(open);
  EXPECT_FALSE(round_lamp(open));
  AreaEmitter twice = ball(placed);
  twice.triangles.insert(twice.triangles.end(), twice.triangles.begin(), twice.triangles.end());
  finish(twice);
  EXPECT_FALSE(round_lamp(twice));
}

TEST(RoundLamp, IsNotWhatIsUnseenOrBrighterInPlaces) {
  AreaEmitter hidden = ball(placed);
  hidden.seen = false;
  EXPECT_FALSE(round_lamp(hidden));
  AreaEmitter spotted = ball(placed);
  spotted.triangles[40].mean_radiance = Rgb(30);
  finish(spotted);
  EXPECT_FALSE(round_lamp(spotted));
  AreaEmitter dark = ball(placed);
  for (auto& t : dark.triangles) t.mean_radiance = Rgb(0);
  finish(dark);
  EXPECT_FALSE(round_lamp(dark));
}

TEST(RoundLamp, ConesHaveTheirDensity) {
  // A disc seen from its axis: the mean of the cosine over the cone is its middle one, (1 + cos)/2, at any
  // size; and all directions meet the ball within the span.
  const RoundLamp lamp{{1, 2, 3}, 0.5f};
  for (const float distance : {0.51f, 2.0f, 40.0f, 1000.0f}) {
    const Vec3f from = lamp.center + normalize(Vec3f{1, -2, 0.3f}) * distance;
    const auto cone = lamp.cone(from);
    ASSERT_TRUE(cone) << distance;
    const double sine = 0.5 / distance, below = 1 - std::sqrt(1 - sine * sine);
    EXPECT_NEAR(cone->pdf() * 2 * kPiD * below, 1, 1e-3) << distance;
    double sum = 0;
    constexpr int kSide = 64;
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const Vec3f w = cone->sample({(i + 0.5f) / kSide, (j + 0.5f) / kSide});
        EXPECT_NEAR(length(w), 1, 1e-6);
        sum += 0.5 * length_squared(w - cone->axis) / (kSide * kSide);  // 1 - cosine, exact where it is small
        const Vec2f span = lamp.span(from, w);
        ASSERT_LT(span.x, span.y) << distance;
        EXPECT_LT(span.x, distance);
        EXPECT_GT(span.y, distance - 0.5f);
      }
    }
    EXPECT_NEAR(sum / (below / 2), 1, 2e-3) << distance;
  }
  EXPECT_FALSE(lamp.cone(lamp.center + Vec3f{0.3f, 0, 0}));
  EXPECT_FALSE(lamp.cone(lamp.center));
  EXPECT_FALSE(lamp.cone({1e5f, 0, 0}));
  const Vec2f aside = lamp.span({1, 2, 0}, {1, 0, 0});
  EXPECT_GT(aside.x, aside.y);
}

}  // namespace
}  // namespace lumirank::emitters
