// What every BSDF must keep at any pair of directions: reciprocity, weight = f·cos/pdf, both senses of
// transport, finite numbers at grazing angles, two sides alike.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "base/warp.h"
#include "scatter/bsdf_list.h"

namespace lumirank::scatter {
namespace {

class EveryBsdfPair : public testing::TestWithParam<int> {
 protected:
  const BsdfCase& bsdf() const { return bsdf_list()[static_cast<std::size_t>(GetParam())]; }
  Rng rng() const { return Rng(3, Stage::test, static_cast<std::uint64_t>(GetParam())); }
  Vec3f arrival(Rng& r) const {
    Vec3f w = warp_sphere(r.next_2d());
    if (!bsdf().inside_too) w.z = std::abs(w.z);
    return w;
  }
};

// Values carry the roundings of half vectors, which a sharp lobe amplifies by 1/alpha².
float slack(const Closure& c) {
  const float alpha = std::max(1e-3f, c.roughness());
  return 1e-5f + 4e-7f / (alpha * alpha);
}

void expect_close(Rgb a, Rgb b, float relative, const std::string& what) {
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(a[k], b[k], relative * (std::abs(a[k]) + std::abs(b[k])) + 1e-6f) << what;
}

// f(wo, wi) = f(wi, wo), and for refraction f(wo, wi)·eta_i² = f(wi, wo)·eta_o² (Walter et al. 2007). A pair
// that sees two different closures (another side, another material) is compared across them.
TEST_P(EveryBsdfPair, IsReciprocal) {
  const BsdfCase& c = bsdf();
  const SurfacePoint at = point_with_normal({0, 0, 1});
  Rng r = rng();
  for (int i = 0; i < 2000; ++i) {
    const Vec3f wo = arrival(r), wi = arrival(r);
    const Closure from_o = c.set.closure(c.material, at, wo), from_i = c.set.closure(c.material, at, wi);
    Rgb forth = eval_f(from_o, wo, wi), back = eval_f(from_i, wi, wo);
    if (wo.z * wi.z < 0) {
      forth *= wi.z < 0 ? c.eta * c.eta : 1;
      back *= wo.z < 0 ? c.eta * c.eta : 1;
    }
    expect_close(forth, back, slack(from_o), c.name);
    // The adjoint is the same with the directions exchanged.
    EXPECT_EQ(eval_f(from_o, wo, wi, true), eval_f(from_o, wi, wo)) << c.name;
  }
}

TEST_P(EveryBsdfPair, WeightIsValueOverPdf) {
  const BsdfCase& c = bsdf();
  const SurfacePoint at = point_with_normal({0, 0, 1});
  Rng r = rng();
  for (int i = 0; i < 2000; ++i) {
    const Vec3f wo = arrival(r);
    const Closure closure = c.set.closure(c.material, at, wo);
    const float u1 = r.next_float();
    const Vec2f u2 = r.next_2d();
    for (const Lobes which : {Lobes::non_delta, Lobes::all}) {
      for (const bool adjoint : {false, true}) {
        const auto s = sample(closure, wo, u1, u2, which, adjoint);
        if (!s || s->delta) continue;
        EXPECT_NEAR(pdf(closure, wo, s->wi, which), s->pdf, 1e-4f * s->pdf) << c.name;
        expect_close(eval(closure, wo, s->wi, adjoint), s->weight * s->pdf, 1e-4f, c.name);
        EXPECT_EQ(s->transmitted, !c.fiber && wo.z * s->wi.z < 0) << c.name;
      }
    }
    // Radiance is scaled by the squared relative index where it crosses the surface, particles are not.
    const auto radiance = sample(closure, wo, u1, u2, Lobes::all, false);
    const auto particle = sample(closure, wo, u1, u2, Lobes::all, true);
    ASSERT_EQ(radiance.has_value(), particle.has_value());
    if (radiance)
      expect_close(radiance->weight * (radiance->eta * radiance->eta), particle->weight, 1e-5f, c.name);
  }
}

TEST_P(EveryBsdfPair, DeltaContinuationsAreWhatDeltaSamplesDraw) {
  const BsdfCase& c = bsdf();
  const SurfacePoint at = point_with_normal({0, 0, 1});
  Rng r = rng();
  for (int i = 0; i < 200; ++i) {
    const Vec3f wo = arrival(r);
    const Closure closure = c.set.closure(c.material, at, wo);
    DeltaContinuation all[kMaxLobes + 1];
    const int n = delta_continuations(closure, wo, all);
    const auto s = sample(closure, wo, r.next_float(), r.next_2d(), Lobes::delta);
    EXPECT_EQ(n > 0, s.has_value()) << c.name;
    if (!s) continue;
    ASSERT_TRUE(s->delta);
    bool found = false;
    for (int k = 0; k < n; ++k) {
      // Two lobes may go the same way: a mirror's and its coating's.
      const float off = norm2(all[k].weight - s->weight * s->pdf);
      found = found || (all[k].kind == s->kind && length(all[k].wi - s->wi) <= 1e-6f &&
                        off <= 2e-5f * norm2(all[k].weight));
    }
    EXPECT_TRUE(found) << c.name;
    // Values of non-delta lobes do not see them.
    EXPECT_EQ(pdf(closure, wo, s->wi, Lobes::delta), 0);
  }
}

TEST_P(EveryBsdfPair, GrazingAnglesAreSafe) {
  const BsdfCase& c = bsdf();
  const SurfacePoint at = point_with_normal({0, 0, 1});
  Rng r = rng();
  const float heights[] = {0, 1e-12f, 1e-7f, 2e-6f, 1e-4f, 1e-2f, 1};
  for (float a : heights) {
    for (float b : heights) {
      for (int signs = 0; signs < 4; ++signs) {
        const Vec3f wo = at_angle(a, 0.4f) + Vec3f{0, 0, signs & 1 ? -2 * a : 0};
        const Vec3f wi = at_angle(b, 6.28f * r.next_float()) + Vec3f{0, 0, signs & 2 ? -2 * b : 0};
        const Closure closure = c.set.closure(c.material, at, wo);
        const Rgb value = eval(closure, wo, wi);
        EXPECT_TRUE(is_finite(value)) << c.name << ' ' << a << ' ' << b;
        EXPECT_TRUE(value.r >= 0 && value.g >= 0 && value.b >= 0) << c.name;
        const float density = pdf(closure, wo, wi, Lobes::all);
        EXPECT_TRUE(std::isfinite(density) && density >= 0) << c.name << ' ' << a << ' ' << b;
        EXPECT_TRUE(is_finite(albedo(closure, wo))) << c.name;
        for (int i = 0; i < 20; ++i) {
          const float u1 = r.next_float();
          const auto s = sample(closure, wo, u1, r.next_2d(), Lobes::all);
          if (!s) continue;
          EXPECT_TRUE(is_finite(s->weight) && is_finite(s->wi)) << c.name << ' ' << a;
          EXPECT_TRUE(s->pdf > 0 && std::isfinite(s->pdf)) << c.name;
        }
      }
    }
  }
}

// The corners of the unit square and its center lead to valid samples too.
TEST_P(EveryBsdfPair, ExtremeRandomNumbersAreSafe) {
  const BsdfCase& c = bsdf();
  const SurfacePoint at = point_with_normal({0, 0, 1});
  const float last = 0x1.fffffep-1f, us[] = {0, 0x1p-24f, 0.5f, last};
  for (float cos_theta : {1.0f, 0.6f, 0.01f, -0.5f}) {
    const Vec3f wo = at_angle(cos_theta, 1);
    const Closure closure = c.set.closure(c.material, at, wo);
    for (float u1 : us)
      for (float u : us)
        for (float v : us) {
          const auto s = sample(closure, wo, u1, {u, v}, Lobes::all);
          if (!s) continue;
          EXPECT_TRUE(is_finite(s->weight) && is_finite(s->wi)) << c.name;
          EXPECT_NEAR(length(s->wi), 1, 1e-5f) << c.name;
        }
  }
}

// Nothing passes where the shading and the geometric normal disagree about a direction's side, unless it is
// transmitted.
TEST_P(EveryBsdfPair, NoLeaksUnderTiltedShadingNormals) {
  const BsdfCase& c = bsdf();
  if (c.fiber) return;  // it has no sides
  SurfacePoint at = point_with_normal({0, 0, 1});
  at.shading = Frame::from_normal(normalize({0.6f, 0.2f, 0.7f}));
  Rng r = rng();
  for (int i = 0; i < 1000; ++i) {
    const Vec3f wo = arrival(r), wi = warp_sphere(r.next_2d());
    const Closure closure = c.set.closure(c.material, at, wo);
    ASSERT_GE(dot(closure.frame.n, closure.ng), 0) << c.name;
    const bool o_agrees = dot(wo, closure.ng) * dot(wo, closure.frame.n) > 0;
    const bool i_agrees = dot(wi, closure.ng) * dot(wi, closure.frame.n) > 0;
    if (!o_agrees || !i_agrees) {
      EXPECT_EQ(eval(closure, wo, wi), Rgb(0)) << c.name;
    }
    const float u1 = r.next_float();
    const auto s = sample(closure, wo, u1, r.next_2d(), Lobes::all);
    if (!s || s->kind == LobeKind::delta_pass) continue;
    EXPECT_EQ(dot(s->wi, closure.ng) * dot(wo, closure.ng) < 0, s->transmitted) << c.name;
    EXPECT_EQ(dot(s->wi, closure.frame.n) * dot(wo, closure.frame.n) < 0, s->transmitted) << c.name;
  }
}

INSTANTIATE_TEST_SUITE_P(List, EveryBsdfPair, testing::Range(0, static_cast<int>(bsdf_list().size())),
                         name_of);

TEST(TwoSided, LooksTheSameFromBothSides) {
  for (const BsdfCase& c : bsdf_list()) {
    if (c.name != "twosided_diffuse" && c.name != "twosided_conductor") continue;
    const SurfacePoint at = point_with_normal({0, 0, 1});
    Rng r(5, Stage::test);
    for (int i = 0; i < 500; ++i) {
      const Vec3f wo = warp_sphere(r.next_2d()), wi = warp_sphere(r.next_2d());
      const Vec3f wo2{wo.x, wo.y, -wo.z}, wi2{wi.x, wi.y, -wi.z};
      EXPECT_EQ(eval(c.set.closure(c.material, at, wo), wo, wi),
                eval(c.set.closure(c.material, at, wo2), wo2, wi2));
    }
  }
}

}  // namespace
}  // namespace lumirank::scatter
