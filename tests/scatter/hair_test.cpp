// What is known in closed form of Kajiya-Kay hair.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "base/warp.h"
#include "scatter/bsdf_list.h"

namespace lumirank::scatter {
namespace {

Closure hair(float diffuse, float specular, float exponent, MaterialSet& set) {
  set.materials = {HairMaterial{{Rgb(diffuse), -1}, {Rgb(specular), -1}, {exponent, -1}}};
  return set.closure(0, point_with_normal({0, 0, 1}), {0, 0, 1});
}

TEST(Hair, LooksTheSameAllAroundTheFiber) {
  MaterialSet set;
  const Closure c = hair(0.3f, 0.5f, 30, set);
  EXPECT_TRUE(c.is_fiber());
  EXPECT_EQ(c.ng, Vec3f{});
  Rng rng(1, Stage::test);
  for (int k = 0; k < 500; ++k) {
    const Vec3f wo = warp_sphere(rng.next_2d()), wi = warp_sphere(rng.next_2d());
    const Vec3f o = c.frame.to_local(wo), i = c.frame.to_local(wi);
    const float a = 6.28f * rng.next_float(), ro = std::hypot(o.y, o.z), ri = std::hypot(i.y, i.z);
    const Vec3f turned_o = c.frame.to_world({o.x, ro * std::cos(a), ro * std::sin(a)});
    const Vec3f turned_i = c.frame.to_world({i.x, ri * std::sin(3 * a), ri * std::cos(3 * a)});
    const float f = eval(c, wo, wi).r;
    EXPECT_NEAR(eval(c, turned_o, turned_i).r, f, 1e-4f * f + 1e-6f);
  }
}

TEST(Hair, SpecularPeakLiesOnTheConeOfMirrorDirections) {
  MaterialSet set;
  const Closure c = hair(0, 1, 100, set);
  const auto at = [&](float latitude) {
    return c.frame.to_world({std::sin(latitude), std::cos(latitude) * 0.6f, std::cos(latitude) * 0.8f});
  };
  for (const float phi : {-0.9f, -0.2f, 0.0f, 0.6f}) {
    const float peak = eval_f(c, at(phi), at(-phi)).r;
    for (const float off : {0.1f, -0.1f}) {
      // cosⁿ of the angle off, and at most the denominators' change.
      const float max_value = std::max(1.0f, std::pow(std::cos(phi) / std::cos(-phi + off), 2.0f));
      EXPECT_LE(eval_f(c, at(phi), at(-phi + off)).r,
                peak * std::pow(std::cos(off), 100.0f) * max_value * 1.0001f);
    }
  }
}

// At light across the fiber the share that comes back is W(n + 2)/W(n) = (n + 1)/(n + 2): cos²φ under cosⁿ.
TEST(Hair, ShareOfTheSpecularLobeAtLightAcross) {
  for (const float n : {0.0f, 1.0f, 10.0f, 300.0f}) {
    MaterialSet set;
    const Closure c = hair(0, 1, n, set);
    // ∫ f·c dω = 2π ∫ f cos²φ dφ by 2000 midpoints.
    double share = 0;
    constexpr int kSteps = 2000;
    for (int k = 0; k < kSteps; ++k) {
      const double phi = 3.14159265358979 * ((k + 0.5) / kSteps - 0.5);
      const Vec3f wi =
          c.frame.to_world({static_cast<float>(std::sin(phi)), 0, static_cast<float>(std::cos(phi))});
      share += eval(c, c.frame.n, wi).r * std::cos(phi) * 2 * 3.14159265358979 * 3.14159265358979 / kSteps;
    }
    EXPECT_NEAR(share, (n + 1) / (n + 2), 2e-4) << n;
  }
}

}  // namespace
}  // namespace lumirank::scatter
