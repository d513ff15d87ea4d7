// Bounds of closures: above every value, and not far above where the cone is small.
#include "scatter/lobe_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/warp.h"
#include "scatter/bsdf_list.h"

namespace lumirank::scatter {
namespace {

class EveryBsdfBound : public testing::TestWithParam<int> {
 protected:
  const BsdfCase& bsdf() const { return bsdf_list()[static_cast<std::size_t>(GetParam())]; }
  Vec3f direction(Rng& r, bool both_sides) const {
    Vec3f w = warp_sphere(r.next_2d());
    // Some near the horizon and some near the normal.
    const float kind = r.next_float();
    if (kind < 0.15f) w = normalize({w.x, w.y, 0.01f * w.z});
    if (kind > 0.85f) w = normalize({0.05f * w.x, 0.05f * w.y, w.z});
    if (!both_sides) w.z = std::abs(w.z);
    return w;
  }
};

// Uniform in the cone.
Vec3f direction_in(const DirectionCone& cone, Vec2f u) {
  const float below = u.x * 2 * square(std::sin(0.5f * std::min(cone.angle, kPi)));
  const float s = std::sqrt(std::max(0.0f, below * (2 - below))), phi = 2 * kPi * u.y;
  return normalize(Frame::from_normal(cone.axis).to_world({s * std::cos(phi), s * std::sin(phi), 1 - below}));
}

void expect_below(Rgb value, Rgb bound, const std::string& what) {
  for (int c = 0; c < 3; ++c) {
    ASSERT_TRUE(std::isfinite(bound[c])) << what;
    // What has no digits any more is no value; kernels make it 0.
    if (value[c] > 1e-35f) {
      ASSERT_LE(value[c], bound[c]) << what;
    }
  }
}

// Random wo and cones of all sizes, many of them about the mirror direction and about directions that the
// closure itself draws; 16 directions in each, and half of them at the rim.
TEST_P(EveryBsdfBound, IsAboveAllValues) {
  const BsdfCase& c = bsdf();
  const SurfacePoint at = point_with_normal({0, 0, 1});
  Rng r(11, Stage::test, static_cast<std::uint64_t>(GetParam()));
  for (int i = 0; i < 1500; ++i) {
    const Vec3f wo = direction(r, c.inside_too);
    const Closure closure = c.set.closure(c.material, at, wo);
    const bool adjoint = r.next_float() < 0.5f;
    const float limit = r.next_float() < 0.2f ? 0.15f : 0.0f;
    const Closure kept = limit > 0 ? broad_part(closure, limit) : closure;
    const ClosureBound bound(closure, wo, adjoint);
    const Rgb anywhere = bound.anywhere(CosineFactor::cosine, limit),
              f_anywhere = bound.anywhere(CosineFactor::none, limit);
    DirectionCone cone;
    cone.angle = r.next_float() < 0.1f ? 0.0f : kPi * std::pow(10.0f, -5 * r.next_float());
    const float kind = r.next_float();
    cone.axis = direction(r, true);
    if (kind < 0.3f) cone.axis = {-wo.x, -wo.y, wo.z};
    if (kind > 0.6f) {
      const auto s = sample(closure, wo, r.next_float(), r.next_2d(), Lobes::non_delta, adjoint);
      if (s) cone.axis = s->wi;
    }
    // Off center, so that peaks may lie anywhere in the cone.
    if (r.next_float() < 0.7f) cone.axis = direction_in(cone, r.next_2d());
    const Rgb in_cone = bound.within(cone, CosineFactor::cosine, limit),
              f_in_cone = bound.within(cone, CosineFactor::none, limit);
    for (int k = 0; k < 16; ++k) {
      Vec3f w = direction_in(cone, {k % 2 ? r.next_float() : 1.0f, r.next_float()});
      if (k == 0) w = cone.axis;
      const Rgb f = eval_f(kept, wo, w, adjoint), value = f * kept.cosine(w);
      const std::string what = c.name + ", cone of " + std::to_string(cone.angle);
      expect_below(f, f_in_cone, what);
      expect_below(value, in_cone, what);
      expect_below(f, f_anywhere, what + ", anywhere");
      expect_below(value, anywhere, what + ", anywhere");
    }
  }
}

// A cone that is one direction: the bound is the value times a number that the formulas account for.
// Transmittances and Fresnel factors count as 1 or as at right angles, tangents are unknown; the loosest is
// what lies under a coat thinner than air, where directions spread.
TEST_P(EveryBsdfBound, OfOneDirectionIsNearTheValue) {
  const BsdfCase& c = bsdf();
  const SurfacePoint at = point_with_normal({0, 0, 1});
  Rng r(12, Stage::test, static_cast<std::uint64_t>(GetParam()));
  double sum = 0, bounds = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3f wo = direction(r, c.inside_too);
    const Closure closure = c.set.closure(c.material, at, wo);
    const ClosureBound bound(closure, wo);
    const auto s = sample(closure, wo, r.next_float(), r.next_2d(), Lobes::non_delta);
    if (!s || std::abs(wo.z) < 0.1f || closure.cosine(s->wi) < 0.1f) continue;
    const float value = mean(eval(closure, wo, s->wi));
    if (!(value > 0)) continue;  // a direction drawn at the very edge of a lobe
    const float bound_here = mean(bound.within({s->wi, 0}, CosineFactor::cosine));
    sum += 1, bounds += std::log(bound_here / value);
  }
  if (sum == 0) return;  // delta lobes alone
  EXPECT_LE(std::exp(bounds / sum), 5) << c.name;
}

INSTANTIATE_TEST_SUITE_P(List, EveryBsdfBound, testing::Range(0, static_cast<int>(bsdf_list().size())),
                         name_of);

}  // namespace
}  // namespace lumirank::scatter
