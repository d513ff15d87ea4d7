#include "emitters/environment.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/transform.h"
#include "support/statistics.h"

namespace lumirank::emitters {
namespace {

using test::ChiSquareTest;
using test::expect_mean;
using test::RunningMean;

Frame turned() {
  const Transform t = Transform::rotate(1, 2, -1, 50) * Transform::scale(-1, 1, 1);  // a mirroring too
  return {normalize(t.vector({1, 0, 0})), normalize(t.vector({0, 1, 0})), normalize(t.vector({0, 0, 1}))};
}

// A map with a bright spot, a black region larger than the reach of the interpolation, and odd sizes.
EnvironmentEmitter spotted(int width = 24, int height = 13) {
  std::vector<Rgb> map(static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Rng rng(1, Stage::test, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y));
      const bool black = x > 4 && x < 9 && y > 3;
      map[static_cast<std::size_t>(y) * width + x] =
          black ? Rgb(0) : Rgb(rng.next_float(), rng.next_float(), rng.next_float());
    }
  map[static_cast<std::size_t>(2) * width + 20] = Rgb(200, 100, 50);
  return make_environment(width, height, std::move(map), turned());
}

TEST(Environment, Orientation) {
  // Mitsuba: u = atan2(x, -z)/2π, so the left edge of the map is -z and its first quarter +x; the top row is
  // +y.
  std::vector<Rgb> map(8 * 4, Rgb(0));
  map[1 * 8 + 1] = Rgb(1);  // longitude 1.5/8 · 2π, polar angle 1.5/4 · π
  const EnvironmentEmitter e = make_environment(8, 4, map, Frame{});
  const double phi = 1.5 / 8 * 2 * kPiD, theta = 1.5 / 4 * kPiD;
  const Vec3f towards{static_cast<float>(std::sin(theta) * std::sin(phi)),
                      static_cast<float>(std::cos(theta)),
                      static_cast<float>(-std::sin(theta) * std::cos(phi))};
  EXPECT_NEAR(e.eval(towards).r, 1, 1e-5);
  EXPECT_EQ(e.eval(-towards).r, 0);
  EXPECT_GT(towards.x, 0);
  EXPECT_GT(towards.y, 0);
  EXPECT_LT(towards.z, 0);
  // Turned by 90° about +y, the local +x axis lies along the world's -z.
  const Transform t = Transform::rotate(0, 1, 0, 90);
  const EnvironmentEmitter r =
      make_environment(8, 4, map, {t.vector({1, 0, 0}), t.vector({0, 1, 0}), t.vector({0, 0, 1})});
  EXPECT_NEAR(r.eval(t.vector(towards)).r, 1, 1e-5);
}

TEST(Environment, MapPositionsAndDirectionsAreInverse) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    Rng rng(2, Stage::test, i);
    const Vec2f p{rng.next_float() * 512, 1 + rng.next_float() * 254};
    const Vec2f q = map_position(map_direction(p, 512, 256), 512, 256);
    // A direction holds angles to about 10⁻⁷ over the sine of the polar angle, and a column is 2π/512.
    EXPECT_NEAR(p.x, q.x, 5e-3);
    EXPECT_NEAR(p.y, q.y, 1e-3);
  }
}

TEST(Environment, DensityIntegratesToOne) {
  // The density is constant over a texel, so the sum over texels of its value times their solid angle is the
  // integral.
  const EnvironmentEmitter e = spotted();
  double sum = 0;
  for (int y = 0; y < e.height; ++y)
    for (int x = 0; x < e.width; ++x) {
      const Vec3f local =
          map_direction({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, e.width, e.height);
      const double solid =
          (std::cos(kPiD * y / e.height) - std::cos(kPiD * (y + 1) / e.height)) * 2 * kPiD / e.width;
      sum += e.pdf(e.to_world.to_world(local)) * solid;
    }
  EXPECT_NEAR(sum, 1, 1e-5);
}

TEST(Environment, SamplesFollowTheDensity) {
  const EnvironmentEmitter e = spotted();
  constexpr int n = 200000;
  std::vector<int> counts(static_cast<std::size_t>(e.width) * e.height);
  for (std::uint64_t i = 0; i < n; ++i) {
    Rng rng(3, Stage::test, i);
    const auto s = e.sample(rng.next_2d());
    const Vec2f p = map_position(e.to_world.to_local(s.direction), e.width, e.height);
    const int x = std::min(static_cast<int>(p.x), e.width - 1),
              y = std::min(static_cast<int>(p.y), e.height - 1);
    ++counts[static_cast<std::size_t>(y) * e.width + x];
    ASSERT_GT(s.pdf, 0);
  }
  ChiSquareTest chi2;
  for (int y = 0; y < e.height; ++y)
    for (int x = 0; x < e.width; ++x) {
      const double expected = n * static_cast<double>(e.rows.pmf(static_cast<std::size_t>(y))) *
                              e.columns[static_cast<std::size_t>(y)].pmf(static_cast<std::size_t>(x));
      const double count = counts[static_cast<std::size_t>(y) * e.width + x];
      if (expected == 0) {
        EXPECT_LE(count, 2);  // rounding at a texel's edge
      }
      chi2.add(count, expected);
    }
  EXPECT_GT(chi2.tail(), 1e-5);
}

TEST(Environment, DensityOfASampleAgreesWithPdf) {
  const EnvironmentEmitter e = spotted();
  float brightest = 0;
  for (const Rgb& texel : e.radiance) brightest = std::max(brightest, max_component(texel));
  int differ = 0;
  for (std::uint64_t i = 0; i < 10000; ++i) {
    Rng rng(4, Stage::test, i);
    const auto s = e.sample(rng.next_2d());
    const Rgb again = e.eval(s.direction);  // from the rounded direction
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(s.radiance[c], again[c], 1e-5f * brightest);
    const auto seen = e.look(s.direction);
    EXPECT_EQ(seen.radiance, again);
    EXPECT_EQ(seen.pdf, e.pdf(s.direction));
    if (std::abs(seen.pdf / s.pdf - 1) > 1e-4f) ++differ;
  }
  // Only samples within rounding (some 10⁻⁶ of a texel's width) of an edge may be read as the neighbor's.
  EXPECT_LE(differ, 3);
}

TEST(Environment, StepByStepItIsTheSame) {
  for (const EnvironmentEmitter& e :
       {spotted(), spotted(300, 170), make_environment(1, 1, {Rgb(2)}, turned())})
    for (std::uint64_t i = 0; i < 2000; ++i) {
      Rng rng(5, Stage::test, i);
      const Vec2f u = rng.next_2d();
      const auto row = e.fetch_row(u);
      e.fetch_column(u, row);
      const auto stepped = e.sample_in(e.fetch_texel(u, row)), whole = e.sample(u);
      ASSERT_EQ(stepped.direction, whole.direction);
      ASSERT_EQ(stepped.radiance, whole.radiance);
      ASSERT_EQ(stepped.pdf, whole.pdf);
      const Vec2f position = e.fetch_position(whole.direction);
      const auto seen = e.look(whole.direction);
      ASSERT_EQ(e.eval_at(position), seen.radiance);
      ASSERT_EQ(e.pdf_at(position), seen.pdf);
    }
}

TEST(Environment, TheDensityIsZeroOnlyWhereTheRadianceIs) {
  const EnvironmentEmitter e = spotted();
  int black = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    Rng rng(5, Stage::test, i);
    const Vec3f d =
        normalize(Vec3f{rng.next_float() - 0.5f, rng.next_float() - 0.5f, rng.next_float() - 0.5f});
    if (e.pdf(d) == 0) {
      EXPECT_TRUE(is_black(e.eval(d)));
      ++black;
    }
  }
  EXPECT_GT(black, 0);
}

TEST(Environment, TotalByQuadratureAndPowerByEmission) {
  const EnvironmentEmitter e = spotted();
  // Midpoints of 64 × 64 parts of every texel, in cosθ and longitude.
  constexpr int k = 64;
  double sum[3] = {0, 0, 0};
  for (int y = 0; y < e.height * k; ++y)
    for (int x = 0; x < e.width * k; ++x) {
      const Vec2f p{(static_cast<float>(x) + 0.5f) / k, (static_cast<float>(y) + 0.5f) / k};
      const double solid = (std::cos(kPiD * y / (e.height * k)) - std::cos(kPiD * (y + 1) / (e.height * k))) *
                           2 * kPiD / (e.width * k);
      const Rgb c = e.eval(e.to_world.to_world(map_direction(p, e.width, e.height)));
      for (int i = 0; i < 3; ++i) sum[i] += c[i] * solid;
    }
  const Rgb total = total_radiance(e);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(total[i] / sum[i], 1, 1e-4);  // the midpoint rule's (1/64)² of the variation

  Bounds3f scene;
  scene.extend(Vec3f{-1, -1, -1});
  scene.extend(Vec3f{2, 3, 1});
  const Emitter emitter{"", 0, e};
  RunningMean mean;
  for (std::uint64_t i = 0; i < 100000; ++i) {
    Rng rng(6, Stage::test, i);
    const Vec2f up = rng.next_2d(), ud = rng.next_2d();
    const Emission s = sample_emission(emitter, scene, 0, up, ud);
    mean.add(s.weight.g);
    ASSERT_NEAR(dot(s.origin - scene.center(), s.direction), -scene.radius(), 1e-5 * scene.radius());
  }
  const Rgb p = power(emitter, scene.radius());
  expect_mean(mean, p.g, 1e-4);
  EXPECT_NEAR(p.g, total.g * kPiD * scene.radius() * scene.radius(), 1e-5 * p.g);
}

TEST(Environment, ConstantLightGivesPiTimesItsRadiance) {
  const Emitter e{"", 0, make_environment(1, 1, {Rgb(0.5f, 1, 2)}, Frame{})};
  RunningMean mean;
  for (std::uint64_t i = 0; i < 40000; ++i) {
    Rng rng(7, Stage::test, i);
    const DirectSample s = sample_direct(e, {5, 5, 5}, 0, rng.next_2d());
    ASSERT_TRUE(std::isinf(s.distance));
    ASSERT_NEAR(s.pdf, 1 / (4 * kPiD), 1e-6);
    mean.add(s.radiance.b * std::max(0.0f, s.direction.x) / s.pdf);
  }
  expect_mean(mean, 2 * kPiD);
  EXPECT_NEAR(power(e, 3).b, 4 * kPiD * kPiD * 9 * 2, 1e-2);  // L · 4π · πR²
}

TEST(Environment, ABlackMapIsNeverSampled) {
  const EnvironmentEmitter e = make_environment(4, 2, std::vector<Rgb>(8, Rgb(0)), Frame{});
  EXPECT_EQ(e.sample({0.3f, 0.4f}).pdf, 0);
  EXPECT_EQ(e.pdf({0, 1, 0}), 0);
}

}  // namespace
}  // namespace lumirank::emitters
