// No BSDF makes energy; lossless ones lose none; albedo() says how much comes back.
#include <gtest/gtest.h>

#include <array>

#include "base/random.h"
#include "scatter/bsdf_list.h"
#include "support/statistics.h"

namespace lumirank::scatter {
namespace {

using test::RunningMean;

class EveryBsdfEnergy : public testing::TestWithParam<int> {};

// 3σ, one-sided, is passed by chance in 99.87 %; 4.5σ keeps the whole list of some 600 comparisons under 1 %.
constexpr double kSigmas = 4.5;

// The furnace: energy of particles (adjoint transport has no radiance scaling) over all lobes.
TEST_P(EveryBsdfEnergy, AlbedoIsAtMostOne) {
  const BsdfCase& c = bsdf_list()[static_cast<std::size_t>(GetParam())];
  const SurfacePoint at = point_with_normal(normalize({-0.2f, 0.9f, 0.3f}));
  for (float cos_theta : {1.0f, 0.8f, 0.4f, 0.1f, -0.15f, -0.7f}) {
    if (cos_theta < 0 && !c.inside_too) continue;
    const Vec3f wo = at.shading.to_world(at_angle(cos_theta, 0.7f));
    const Closure closure = c.set.closure(c.material, at, wo);
    Rng rng(11, Stage::test, static_cast<std::uint64_t>(GetParam()));
    std::array<RunningMean, 3> returned;
    for (int i = 0; i < 40000; ++i) {
      const float u1 = rng.next_float();
      const auto s = sample(closure, wo, u1, rng.next_2d(), Lobes::all, true);
      const Rgb weight = s ? s->weight : Rgb(0);
      for (int k = 0; k < 3; ++k) returned[static_cast<std::size_t>(k)].add(weight[k]);
    }
    const Rgb stated = albedo(closure, wo), rough = rough_albedo(closure, wo);
    for (int k = 0; k < 3; ++k) {
      const RunningMean& energy = returned[static_cast<std::size_t>(k)];
      const double mean = energy.mean(), noise = kSigmas * energy.standard_error() + 1e-5;
      if (c.energy_exempt.empty()) {
        EXPECT_LE(mean, 1 + noise) << c.name << " at cosine " << cos_theta;
      }
      EXPECT_LE(stated[k], 1) << c.name;
      EXPECT_NEAR(rough[k], stated[k], 0.12f) << c.name << " at cosine " << cos_theta;
      // Lossless delta and Lambertian lobes: no noise at all.
      if (c.lossless) {
        EXPECT_NEAR(mean, 1, 1e-5) << c.name << " at cosine " << cos_theta;
      }
      // albedo() promises 0.03, and does not know what the geometric horizon takes away under a bent normal.
      EXPECT_GE(stated[k], std::min(mean, 1.0) - 0.03 - noise) << c.name << " at cosine " << cos_theta;
      if (dot(closure.frame.n, closure.ng) > 0.9999f) {
        EXPECT_LE(stated[k], mean + 0.03 + noise) << c.name << " at cosine " << cos_theta;
      }
    }
  }
}

// Widened lobes shine wider, not more nor less.
TEST_P(EveryBsdfEnergy, StaysWhenLobesAreWidened) {
  constexpr float kLeast = 0.3f;
  const BsdfCase& c = bsdf_list()[static_cast<std::size_t>(GetParam())];
  const SurfacePoint at = point_with_normal(normalize({-0.2f, 0.9f, 0.3f}));
  for (const float cos_theta : {1.0f, 0.7f}) {
    const Vec3f wo = at.shading.to_world(at_angle(cos_theta, 0.7f));
    const Closure closure = c.set.closure(c.material, at, wo), wide = widened(closure, wo, kLeast);
    ASSERT_EQ(wide.count, closure.count);
    for (int k = 0; k < wide.count; ++k) {
      const LobeKind kind = wide.lobes[k].kind;
      EXPECT_EQ(kind, closure.lobes[k].kind);
      const bool stays =
          is_delta(kind) || is_hair(kind) || kind == LobeKind::clearcoat || kind == LobeKind::measured;
      const float was = lobe_roughness(closure.lobes[k]);
      EXPECT_NEAR(lobe_roughness(wide.lobes[k]), stays ? was : std::max(was, kLeast), 1e-4f) << c.name;
    }
    const Closure sharp = broad_part(closure, 0), blurred = broad_part(wide, 0);
    if (sharp.empty()) continue;
    const Rgb before = albedo(sharp, wo), after = albedo(blurred, wo);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(after[k], before[k], 1e-3f) << c.name << " at " << cos_theta;
    // A lobe that was sharp is dimmer in its middle now.
    if (closure.roughness() < 0.2f && wide.roughness() > 0.29f) {
      EXPECT_LT(max_component(eval(wide, wo, reflect(wo, closure.frame.n))),
                std::max(1e-3f, max_component(eval(closure, wo, reflect(wo, closure.frame.n)))))
          << c.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(List, EveryBsdfEnergy, testing::Range(0, static_cast<int>(bsdf_list().size())),
                         name_of);

}  // namespace
}  // namespace lumirank::scatter
