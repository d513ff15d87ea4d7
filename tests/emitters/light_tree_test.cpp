// The light tree: what it draws is what it says it draws, and nothing that could shine is left out.
#include "emitters/light_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/frame.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/warp.h"
#include "support/statistics.h"

namespace lumirank::emitters {
namespace {

Vec3f random_direction(Rng& rng) { return warp_sphere(rng.next_2d()); }
Vec3f random_point(Rng& rng, float size) {
  const float x = rng.next_float(), y = rng.next_float();
  return Vec3f{x - 0.5f, y - 0.5f, rng.next_float() - 0.5f} * size;
}

// Points, spots and patches of very different strength, many of them at shared places.
std::vector<LightBound> lights(std::size_t count, std::uint64_t seed) {
  std::vector<LightBound> out(count);
  for (std::size_t k = 0; k < count; ++k) {
    Rng rng(seed, Stage::test, k);
    LightBound& b = out[k];
    const Vec3f at = k % 11 == 0 ? Vec3f{1, 1, 1} : random_point(rng, 10);
    b.bounds.extend(at);
    b.axis = random_direction(rng);
    b.intensity = std::exp(8 * rng.next_float());
    switch (k % 4) {
      case 0:
        b.spread = kPi;
        break;
      case 1:
        b.spread = 1.5f * rng.next_float(), b.reach = rng.next_float();
        break;
      default:
        b.bounds.extend(at + random_point(rng, 0.5f));
    }
    if (k % 17 == 5) b.intensity = 0;
  }
  return out;
}

LitPoint lit_point(Rng& rng) {
  const Vec3f position = random_point(rng, 14);
  return {position, random_direction(rng), rng.next_below(4) == 0};
}

// The larger tree has parts that are built side by side.
TEST(LightTree, WhatIsDrawnHasTheStatedProbability) {
  for (const std::size_t count : {300, 40000}) {
    const auto all = lights(count, 1);
    const LightTree tree(all);
    std::vector<char> drawn(count);
    for (std::uint64_t i = 0; i < 2000; ++i) {
      Rng rng(2, Stage::test, i);
      const LitPoint at = lit_point(rng);
      const auto pick = tree.sample(at, rng.next_double());
      if (!(pick.pmf > 0)) continue;
      drawn[pick.light] = 1;
      EXPECT_GT(all[pick.light].intensity, 0);
      // The same factors, multiplied from the other end in double precision.
      EXPECT_FLOAT_EQ(pick.pmf, tree.pmf(at, pick.light));
    }
    EXPECT_GT(std::count(drawn.begin(), drawn.end(), 1), count == 300 ? 100 : 700);
  }
}

TEST(LightTree, IsTheSameOnAnyNumberOfThreads) {
  const auto all = lights(40000, 7);
  const auto picks = [&](int threads) {
    std::vector<std::pair<std::uint32_t, float>> found;
    with_threads(threads, [&] {
      const LightTree tree(all);
      for (std::uint64_t i = 0; i < 2000; ++i) {
        Rng rng(8, Stage::test, i);
        const LitPoint at = lit_point(rng);
        const auto pick = tree.sample(at, rng.next_double());
        found.emplace_back(pick.light, pick.pmf);
      }
    });
    return found;
  };
  EXPECT_EQ(picks(1), picks(3));
}

TEST(LightTree, ProbabilitiesAddUpToWhatIsDrawn) {
  // Over even strata of u the share of draws that find a light is the sum of the probabilities, to within a
  // stratum for each of the lights, which hold intervals of u.
  const auto all = lights(120, 3);
  const LightTree tree(all);
  constexpr int kStrata = 20000;
  for (std::uint64_t i = 0; i < 40; ++i) {
    Rng rng(4, Stage::test, i);
    const LitPoint at = lit_point(rng);
    std::vector<int> drawn(all.size());
    for (int k = 0; k < kStrata; ++k) {
      const auto pick = tree.sample(at, (k + 0.5) / kStrata);
      if (pick.pmf > 0) ++drawn[pick.light];
    }
    double sum = 0;
    for (std::uint32_t k = 0; k < all.size(); ++k) {
      const double p = tree.pmf(at, k);
      sum += p;
      EXPECT_NEAR(static_cast<double>(drawn[k]) / kStrata, p, 1.01 / kStrata + 1e-5 * p);
    }
    EXPECT_LE(sum, 1 + 1e-5);
  }
}

// Whether the description lets light go from `y` to the point, and how much: intensity · cos · cos / d².
float sent(const LightBound& light, Vec3f y, Vec3f normal, const LitPoint& at) {
  const Vec3f to = at.position - y;
  const float d2 = length_squared(to);
  if (!(d2 > 0)) return 0;
  const Vec3f w = to / std::sqrt(d2);
  const double angle = std::acos(std::clamp(static_cast<double>(dot(w, normal)), -1.0, 1.0));
  if (angle >= light.reach) return 0;
  float received = -dot(w, at.normal);
  if (at.both_sides) received = std::abs(received);
  return received > 0 ? light.intensity * static_cast<float>(std::cos(angle)) * received / d2 : 0;
}

TEST(LightTree, EveryLightThatReachesAPointCanBeDrawn) {
  // Random points in a light's box and normals in its cone are what the bound promises to cover.
  const auto all = lights(400, 5);
  const LightTree tree(all);
  int reached = 0, rarely_drawn = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    Rng rng(6, Stage::test, i);
    const LitPoint at = lit_point(rng);
    const auto k = static_cast<std::uint32_t>(rng.next_below(all.size()));
    const LightBound& b = all[k];
    const Vec3f size = b.bounds.diagonal();
    const float x = rng.next_float(), y = rng.next_float(), z = rng.next_float();
    const Vec3f from = b.bounds.lo + Vec3f{size.x * x, size.y * y, size.z * z};
    const Vec3f normal =
        b.spread >= kPi ? normalize(at.position - from)
                        : Frame::from_normal(b.axis).to_world(warp_cone(rng.next_2d(), std::cos(b.spread)));
    if (!(sent(b, from, normal, at) > 0)) continue;
    ++reached;
    EXPECT_GT(tree.pmf(at, k), 0) << "light " << k << ", draw " << i;
    if (tree.pmf(at, k) < 1e-6f) ++rarely_drawn;
  }
  EXPECT_GT(reached, 3000);
  EXPECT_LT(rarely_drawn, reached / 2) << "the sizes of the test: most lights are drawn with some frequency";
}

TEST(LightTree, LightBehindTheSurfaceOrBeyondItsCutOffIsNotDrawn) {
  LightBound patch, spot;
  patch.bounds.extend(Vec3f{0, 0, 1}), patch.axis = {0, 0, -1}, patch.intensity = 1;
  spot.bounds.extend(Vec3f{2, 0, 1}), spot.axis = {0, 0, -1}, spot.reach = 0.2f, spot.intensity = 1;
  const LightBound both[] = {patch, spot};
  const LightTree tree(both);
  // Below the patch: the spot's cone of 0.2 rad does not reach 2 m to the side.
  EXPECT_EQ(tree.pmf({{0, 0, 0}, {0, 0, 1}, false}, 0), 1);
  // A surface that looks down sees neither, unless it lets light through.
  EXPECT_FALSE(tree.reaches({{0, 0, 0}, {0, 0, -1}, false}));
  EXPECT_EQ(tree.sample({{0, 0, 0}, {0, 0, -1}, false}, 0.5).pmf, 0);
  EXPECT_EQ(tree.pmf({{0, 0, 0}, {0, 0, -1}, true}, 0), 1);
}

TEST(LightTree, NearLightsAreDrawnMoreOften) {
  // Two equal points seen under equal angles at distances 1 and 3: probabilities 9 : 1.
  LightBound near, far;
  near.bounds.extend(Vec3f{0, 0, 1}), near.spread = kPi, near.intensity = 1;
  far.bounds.extend(Vec3f{0, 0, 3}), far.spread = kPi, far.intensity = 1;
  const LightBound both[] = {near, far};
  EXPECT_NEAR(LightTree(both).pmf({{0, 0, 0}, {0, 0, 1}, false}, 0), 0.9, 1e-6);
}

TEST(LightTree, LightsAtOnePlaceAndOfNoIntensity) {
  std::vector<LightBound> all(50);
  for (auto& b : all) b.bounds.extend(Vec3f{1, 2, 3}), b.spread = kPi, b.intensity = 1;
  all[7].intensity = 0;
  const LightTree tree(all);
  // Also from the very place of the lights.
  for (const Vec3f from : {Vec3f{0, 0, 0}, Vec3f{1, 2, 3}})
    for (std::uint32_t k = 0; k < all.size(); ++k)
      EXPECT_NEAR(tree.pmf({from, {0, 0, 1}, false}, k), k == 7 ? 0.0 : 1.0 / 49, 1e-6);
  EXPECT_TRUE(LightTree().empty());
  EXPECT_TRUE(LightTree(std::vector<LightBound>(3)).empty());
}

TEST(LightBound, AConeOfTwoHoldsBoth) {
  for (std::uint64_t i = 0; i < 5000; ++i) {
    Rng rng(8, Stage::test, i);
    LightBound a, b;
    a.axis = random_direction(rng), b.axis = random_direction(rng);
    if (i % 5 == 0) b.axis = a.axis;
    if (i % 7 == 0) b.axis = -a.axis;
    a.spread = kPi * square(rng.next_float()), b.spread = 0.5f * kPi * square(rng.next_float());
    a.intensity = 1, b.intensity = 2;
    const LightBound sum = join(a, b);
    EXPECT_EQ(sum.intensity, 3);
    for (const LightBound* part : {&a, &b}) {
      const Vec3f normal =
          Frame::from_normal(part->axis).to_world(warp_cone(rng.next_2d(), std::cos(part->spread)));
      const double angle =
          2 * std::atan2(static_cast<double>(length(normal - sum.axis)), length(normal + sum.axis));
      EXPECT_LE(angle, sum.spread + 1e-5);
    }
  }
}

}  // namespace
}  // namespace lumirank::emitters
