// Directions that follow a lobe: their density is the one that the integrals divide by.
#include <gtest/gtest.h>

#include <cmath>

#include "base/warp.h"
#include "transport/pairs/sphere_samples.h"

namespace lumirank::transport {
namespace {

struct Lobe {
  bool anisotropic;
  float alpha_u, alpha_v;
  Vec3f wo;
};

class LobeDirections : public ::testing::TestWithParam<Lobe> {
 protected:
  LobeDirections() {
    form_.in_lanes = true, form_.anisotropic = GetParam().anisotropic;
    group_.form = &form_;
    group_.wo = splat(normalize(GetParam().wo));
    const Vec3f n = normalize(Vec3f{0.2f, -0.4f, 0.9f});
    const Frame frame = Frame::from_normal_tangent(n, {1, 1, 0});
    group_.n = splat(frame.n), group_.s = splat(frame.s), group_.t = splat(frame.t);
    group_.cones.alpha_u = splat(GetParam().alpha_u), group_.cones.alpha_v = splat(GetParam().alpha_v);
  }
  ScatterForm form_;
  ScatterGroup group_;
};

// Moments of what is drawn where wo sees the half vector (the others end behind the surface), against the
// same moments of the density by quadrature over the sphere.
TEST_P(LobeDirections, HaveTheirDensity) {
  const LobeSampler lobe(group_);
  const auto moments = [](const Lane3& l) { return std::array<Lane, 4>{splat(1), l.x, l.y, l.z * l.x}; };
  constexpr int kDrawn = 1 << 14, kPoints = 1 << 17;  // times 16
  double drawn[4] = {}, drawn2[4] = {}, exact[4] = {}, coarse[4] = {};
  Rng rng(3, Stage::benchmark);
  for (int k = 0; k < kDrawn; ++k) {
    Lane u, v;
    for (int i = 0; i < kLanes; ++i) u[i] = rng.next_float(), v[i] = rng.next_float();
    const Lane3 l = lobe.direction(u, v);
    const LaneMask seen = lobe.density(l) > Lane{};
    const auto m = moments(l);
    for (std::size_t c = 0; c < 4; ++c)
      for (int i = 0; i < kLanes; ++i) {
        EXPECT_NEAR(l.x[i] * l.x[i] + l.y[i] * l.y[i] + l.z[i] * l.z[i], 1, 1e-5);
        const double x = seen[i] ? static_cast<double>(m[c][i]) : 0;
        drawn[c] += x, drawn2[c] += x * x;
      }
  }
  for (int k = 0; k < kPoints; ++k) {
    Lane3 l;
    for (int i = 0; i < kLanes; ++i) {
      const double number = 16 * k + i, turn = number * 0.6180339887498949;
      const Vec3f at = warp_sphere({static_cast<float>((number + 0.5) / (16.0 * kPoints)),
                                    static_cast<float>(turn - std::floor(turn))});
      l.x[i] = at.x, l.y[i] = at.y, l.z[i] = at.z;
    }
    const Lane p = lobe.density(l);
    const auto m = moments(l);
    for (std::size_t c = 0; c < 4; ++c)
      for (int i = 0; i < kLanes; ++i) {
        const double x = static_cast<double>(p[i] * m[c][i]) * 4 * kPi / (16.0 * kPoints);
        exact[c] += x;
        if (i % 4 == 0) coarse[c] += 4 * x;
      }
  }
  for (std::size_t c = 0; c < 4; ++c) {
    const double n = 16.0 * kDrawn, mean = drawn[c] / n;
    const double error = std::sqrt(std::max(0.0, drawn2[c] / n - mean * mean) / n);
    // 4.5 standard errors: below 1 in 10⁵ for each of the twelve numbers; and what the quadrature leaves.
    EXPECT_NEAR(mean, exact[c], 4.5 * error + std::abs(exact[c] - coarse[c]) + 1e-4) << c;
  }
}

INSTANTIATE_TEST_SUITE_P(Lobes, LobeDirections,
                         ::testing::Values(Lobe{false, 0.15f, 0.15f, {0.3f, -0.2f, 1}},
                                           Lobe{true, 0.08f, 0.3f, {0.3f, -0.2f, 1}},
                                           Lobe{true, 0.2f, 0.1f, {1, 0.3f, 0.35f}}));

}  // namespace
}  // namespace lumirank::transport
