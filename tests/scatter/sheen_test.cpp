// What the sheen's table promises.
#include <gtest/gtest.h>

#include <cmath>

#include "scatter/bsdf_list.h"
#include "scatter/lobes/charlie_sheen.h"

namespace lumirank::scatter {
namespace {

// At a horizontal direction V·cos_i = 1/4 and dwi = 4·(wo·h)·dh, so E(0) = ∫ D(h)·(wo·h) dh over the half of
// the h that face wo = (1/π)·∫ (2 + 1/α)·sin^(2 + 1/α) θ dθ, the integral up to π/2 being
// (√π/2)·Γ((a + 1)/2)/Γ(a/2 + 1) with a = 2 + 1/α. The table starts at a cosine of 0.0001 and its integrals
// have 48 steps, which together are given 3 %.
TEST(CharlieSheen, AtTheHorizonTheAlbedoIsKnown) {
  for (const float roughness : {kMinSheenRoughness, 0.2f, 0.4f, 0.7f, 1.0f}) {
    const double a = 2 + 1 / (double{roughness} * roughness);
    const double e = a * 0.5 / std::sqrt(M_PI) * std::exp(std::lgamma((a + 1) / 2) - std::lgamma(a / 2 + 1));
    EXPECT_NEAR(sheen_albedo(roughness, 0).raw, e, 0.03 * e) << roughness;
  }
}

TEST(CharlieSheen, FallsWithTheCosineAndIsHeldBelowOne) {
  for (int r = 0; r <= 40; ++r) {
    const float roughness = kMinSheenRoughness + (1 - kMinSheenRoughness) * static_cast<float>(r) / 40;
    float last = kInfinity;
    for (int c = 0; c <= 200; ++c) {
      const SheenAlbedo e = sheen_albedo(roughness, static_cast<float>(c) / 200);
      EXPECT_LE(e.raw, last) << roughness << ' ' << c;
      EXPECT_LE(e.held, std::min(1.0f, e.raw) + 1e-6f) << roughness << ' ' << c;
      EXPECT_GE(e.held, 0);
      last = e.raw;
    }
  }
}

// The blue of a sheen that has none is that of the white base, dimmed by the strongest channel's albedo at
// the smaller of the two cosines.
TEST(CharlieSheen, CoversWhatIsBelow) {
  MaterialSet set;
  set.materials.push_back(DiffuseMaterial{{Rgb(1), -1}});
  set.materials.push_back(SheenMaterial{{Rgb(1, 0.5f, 0), -1}, {0.5f, -1}, 0});
  const SurfacePoint at = point_with_normal({0, 0, 1});
  const Closure from_front = set.closure(1, at, {0, 0, 1});
  ASSERT_EQ(from_front.count, 2);
  EXPECT_FALSE(from_front.is_lambertian());
  EXPECT_EQ(set.closure(1, at, {0, 0, -1}).count, 0) << "nothing on the back of a one-sided base";
  const Vec3f o = at_angle(0.3f, 0), i = at_angle(0.8f, 2);
  const float expected = (1 - sheen_albedo(0.5f, 0.3f).raw) * kInvPi;
  EXPECT_NEAR(eval_f(from_front, o, i).b, expected, 2e-5f) << "the layer's share and roughness have 16 bits";
}

}  // namespace
}  // namespace lumirank::scatter
