// Measured BRDFs against the closed forms that their tables were made of; the tests of all BSDFs are in
// bsdf_list.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/warp.h"
#include "scatter/bsdf_list.h"
#include "scatter/merl_table.h"
#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

Rgb ggx(float alpha, Vec3f wo, Vec3f wi) {
  const Vec3f m = normalize(wo + wi);
  return Rgb(0.9f, 0.6f, 0.3f) *
         (ggx_d(m, alpha, alpha) * ggx_g1(wo, alpha, alpha) * ggx_g1(wi, alpha, alpha) / (4 * wo.z * wi.z));
}

Closure closure_of(const std::string& bytes, Vec3f wo) {
  static std::vector<MaterialSet> kept;  // closures point into them
  kept.emplace_back().materials.push_back(MeasuredMaterial{parse_measured(bytes, "test.binary", {})});
  return kept.back().closure(0, point_with_normal({0, 0, 1}), wo);
}

TEST(Measured, LambertComesBackAsItWas) {
  const Rgb color{0.8f, 0.5f, 0.2f};
  const Closure c = closure_of(merl_bytes(6, 5, 4, [&](Vec3f, Vec3f) { return color * kInvPi; }), {0, 0, 1});
  Rng r(5, Stage::test, 1);
  for (int i = 0; i < 500; ++i) {
    const Vec3f wo = warp_cosine_hemisphere(r.next_2d()), wi = warp_cosine_hemisphere(r.next_2d());
    const Rgb f = eval_f(c, wo, wi);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(f[k], color[k] * kInvPi, 1e-6f);
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(albedo(c, {0, 0, 1})[k], color[k], 0.01f);
}

// Between the middles of cells f is linear, so a table of two degrees is within a few percent.
TEST(Measured, GgxComesBackAlmostAsItWas) {
  const float alpha = 0.4f;
  const Closure c =
      closure_of(merl_bytes(90, 45, 36, [&](Vec3f o, Vec3f i) { return ggx(alpha, o, i); }), {0, 0, 1});
  Rng r(5, Stage::test, 2);
  double off = 0;
  int n = 0;
  while (n < 2000) {
    const Vec3f wo = warp_cosine_hemisphere(r.next_2d()), wi = warp_cosine_hemisphere(r.next_2d());
    if (wo.z < 0.3f || wi.z < 0.3f) continue;
    const Rgb f = eval_f(c, wo, wi), exact = ggx(alpha, wo, wi);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(f[k], exact[k], 0.06f * exact[k]);
    off += std::abs(f.r / exact.r - 1), ++n;
  }
  EXPECT_LT(off / n, 0.01);
}

// An uneven table tells each axis, its direction and its spacing: reading one wrongly shows.
TEST(Measured, AxesAreThoseOfTheFormat) {
  const std::size_t cells = 3 * 4 * 5;
  std::string bytes(12 + 3 * cells * 8, '\0');
  const int n[3] = {3, 4, 5};
  std::memcpy(bytes.data(), n, sizeof n);
  const auto value = [](std::size_t h, std::size_t d, std::size_t p) {
    return 0.01 * (1 + static_cast<double>(h)) + 0.001 * static_cast<double>(d) +
           0.0001 * static_cast<double>(p);
  };
  for (std::size_t h = 0; h < 3; ++h)
    for (std::size_t d = 0; d < 4; ++d)
      for (std::size_t p = 0; p < 5; ++p) {
        const double red = value(h, d, p) * 1500;
        std::memcpy(bytes.data() + 12 + ((h * 4 + d) * 5 + p) * 8, &red, 8);
      }
  const Closure c = closure_of(bytes, {0, 0, 1});
  // The middle of cell (0, 1, 2): θh = 90°·(0.5/3)², θd = 90°·1.5/4, φd = 180°·2.5/5 = 90°.
  const float theta_h = 0.5f * kPi / 36, theta_d = 0.5f * kPi * 1.5f / 4;
  const Vec3f half{std::sin(theta_h), 0, std::cos(theta_h)};
  const Vec3f off{0, std::sin(theta_d), 0};
  const Vec3f wi = half * std::cos(theta_d) + off, wo = half * std::cos(theta_d) - off;
  EXPECT_NEAR(eval_f(c, wo, wi).r, value(0, 1, 2), 1e-6);
  EXPECT_NEAR(eval_f(c, wi, wo).r, value(0, 1, 2), 1e-6);
  EXPECT_EQ(eval_f(c, wo, wi).g, 0);
}

TEST(Measured, DrawsFollowTheTable) {
  for (const float alpha : {0.05f, 0.3f}) {
    const Vec3f wo = at_angle(0.8f, 0.4f);
    const Closure c =
        closure_of(merl_bytes(60, 30, 24, [&](Vec3f o, Vec3f i) { return ggx(alpha, o, i); }), wo);
    EXPECT_LT(c.roughness(), 2 * alpha);
    EXPECT_GT(c.roughness(), 0.5f * alpha);
    Rng r(5, Stage::test, 3);
    double sum = 0, squares = 0;
    for (int i = 0; i < 20000; ++i) {
      const float u1 = r.next_float();
      const auto s = sample(c, wo, u1, r.next_2d(), Lobes::non_delta);
      const double w = s ? static_cast<double>(s->weight.r) : 0.0;
      sum += w, squares += w * w;
    }
    // Draws by the cosine alone have 1/(8α²) or so: 50 at 0.05.
    EXPECT_LT(squares * 20000 / (sum * sum), 2) << alpha;
  }
}

TEST(Measured, TooBrightTablesMakeNoLight) {
  const Closure c = closure_of(merl_bytes(6, 5, 4, [](Vec3f, Vec3f) { return Rgb(3 * kInvPi); }), {0, 0, 1});
  EXPECT_NEAR(eval_f(c, {0, 0, 1}, at_angle(0.5f, 1)).r, kInvPi, 0.02f);
  EXPECT_LE(albedo(c, {0, 0, 1}).r, 1);
}

TEST(Measured, BrokenFilesAreRefused) {
  const std::string good = merl_bytes(3, 3, 3, [](Vec3f, Vec3f) { return Rgb(0.1f); });
  const auto refused = [](const std::string& bytes, const std::string& says) {
    try {
      parse_measured(bytes, "skin.binary", {"scene.xml", 7});
    } catch (const InputError& e) {
      const std::string what = e.what();
      EXPECT_NE(what.find("scene.xml:7"), std::string::npos) << what;
      EXPECT_NE(what.find("skin.binary"), std::string::npos) << what;
      EXPECT_NE(what.find(says), std::string::npos) << what;
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused(good, ""));
  EXPECT_TRUE(refused("", "ends within its header"));
  EXPECT_TRUE(refused(good.substr(0, 11), "ends within its header"));
  EXPECT_TRUE(refused(good.substr(0, good.size() - 1), "bytes where its header asks for"));
  EXPECT_TRUE(refused(good + "x", "bytes where its header asks for"));
  EXPECT_TRUE(refused("tensor_file" + good, "RGL"));
  const auto with = [&](std::size_t place, auto value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + place, &value, sizeof value);
    return bytes;
  };
  for (const int n : {0, -3, 2'000'000'000}) EXPECT_TRUE(refused(with(4, n), "no table")) << n;
  EXPECT_TRUE(refused(with(12 + 40, std::nan("")), "not a finite number"));
  EXPECT_TRUE(refused(with(12 + 40, 1e300), "not a finite number"));
  EXPECT_FALSE(refused(with(12 + 40, -1.0), "")) << "values below 0 are those that were not measured";
}

}  // namespace
}  // namespace lumirank::scatter
