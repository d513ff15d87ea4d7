// Normal distributions and masking against their defining integrals, and the interface tables built from
// them.
#include "scatter/microfacet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "base/random.h"
#include "scatter/bsdf_list.h"
#include "scatter/interface_table.h"
#include "support/statistics.h"

namespace lumirank::scatter {
namespace {

using test::ChiSquareTest;

struct Setting {
  NormalDistribution kind;
  float alpha_u, alpha_v;
};
const Setting kSettings[] = {
    {NormalDistribution::ggx, 0.05f, 0.05f},      {NormalDistribution::ggx, 0.3f, 0.3f},
    {NormalDistribution::ggx, 1.0f, 1.0f},        {NormalDistribution::ggx, 0.1f, 0.5f},
    {NormalDistribution::beckmann, 0.05f, 0.05f}, {NormalDistribution::beckmann, 0.3f, 0.3f},
    {NormalDistribution::beckmann, 1.0f, 1.0f},   {NormalDistribution::beckmann, 0.6f, 0.2f}};

// ∫ value(m) dω over the upper hemisphere, midpoint rule; polar angle as t², so that peaks at the pole are
// resolved.
template <typename F>
double over_hemisphere(F&& value) {
  constexpr int n = 600, phis = 300;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n, theta = 0.5 * 3.14159265358979324 * t * t;
    const double weight = std::sin(theta) * 3.14159265358979324 * t / n * 2 * 3.14159265358979324 / phis;
    for (int j = 0; j < phis; ++j) {
      const double phi = 2 * 3.14159265358979324 * (j + 0.5) / phis;
      sum += weight * value(Vec3f{static_cast<float>(std::sin(theta) * std::cos(phi)),
                                  static_cast<float>(std::sin(theta) * std::sin(phi)),
                                  static_cast<float>(std::cos(theta))});
    }
  }
  return sum;
}

// The projected area of all microfacets is that of the surface: ∫ D(m) cos m dω = 1.
TEST(Microfacet, DistributionIsNormalized) {
  for (const Setting& s : kSettings)
    EXPECT_NEAR(over_hemisphere([&](Vec3f m) { return microfacet_d(s.kind, m, s.alpha_u, s.alpha_v) * m.z; }),
                1, 1e-3)
        << s.alpha_u << ' ' << s.alpha_v;
}

// The visible microfacets' projected area is the surface's, seen from anywhere: ∫ G1 D max(0, w·m) dω = cos
// w.
TEST(Microfacet, VisibleNormalsAreNormalized) {
  for (const Setting& s : kSettings) {
    for (float c : {1.0f, 0.6f, 0.15f}) {
      const Vec3f w = at_angle(c, 0.8f);
      EXPECT_NEAR(
          over_hemisphere([&](Vec3f m) { return visible_normal_pdf(s.kind, w, m, s.alpha_u, s.alpha_v); }), 1,
          2e-3)
          << s.alpha_u << ' ' << s.alpha_v << ' ' << c;
    }
  }
}

// Closed form: Λ(a) = (erf(a) - 1)/2 + exp(-a²)/(2a√π).
TEST(Microfacet, BeckmannMaskingMatchesItsClosedForm) {
  for (double a = 0.05; a < 4; a += 0.05) {
    const double exact =
        0.5 * (std::erf(a) - 1) + std::exp(-a * a) / (2 * a * std::sqrt(3.14159265358979324));
    EXPECT_NEAR(beckmann_lambda(static_cast<float>(a)), exact, 1e-6 * (1 + exact)) << a;
  }
}

// GGX: the mean of a coordinate over drawn visible normals against its integral over their density, within
// 4.5 standard deviations (24 comparisons: all pass by chance with more than 99.9 %).
TEST(Microfacet, DrawnNormalsHaveTheRightMean) {
  int stream = 0;
  for (const Setting& s : kSettings) {
    const Vec3f w = at_angle(0.35f, 0.8f);
    Rng rng(1, Stage::test, static_cast<std::uint64_t>(stream++));
    constexpr int n = 50000;
    double sum[3] = {0, 0, 0}, squares[3] = {0, 0, 0};
    for (int i = 0; i < n; ++i) {
      const Vec3f m = sample_visible_normal(s.kind, w, rng.next_2d(), s.alpha_u, s.alpha_v);
      EXPECT_GT(m.z, 0);
      EXPECT_GT(dot(m, w), -1e-4f);
      for (int k = 0; k < 3; ++k) sum[k] += m[k], squares[k] += double(m[k]) * m[k];
    }
    for (int k = 0; k < 3; ++k) {
      const double expected = over_hemisphere(
          [&](Vec3f m) { return m[k] * visible_normal_pdf(s.kind, w, m, s.alpha_u, s.alpha_v); });
      const double mean = sum[k] / n, sigma = std::sqrt((squares[k] / n - mean * mean) / n);
      EXPECT_NEAR(mean, expected, 4.5 * sigma + 2e-3) << s.alpha_u << ' ' << s.alpha_v << " coordinate " << k;
    }
  }
}

// Drawn visible normals against their density, cell by cell, where that is hardest: at grazing angles and
// under strong anisotropy. Cells are even on the hemisphere of normals stretched to roughness 1; m = A·h with
// A = diag(αu, αv, 1) has dω_m = |det A| / |A·h|³ dω_h.
TEST(Microfacet, DrawnNormalsFollowTheirDensityAtGrazingAngles) {
  constexpr int rings = 12, sectors = 16, n = 60000, fine = 24;
  constexpr float angles[] = {0.02f, 0.1f, 0.7f};
  constexpr float alphas[][2] = {{0.02f, 0.6f}, {0.9f, 0.05f}, {0.01f, 0.01f}, {1, 1}};
  // 1 % for all tests together (Bonferroni).
  const double significance = 0.01 / (2.0 * std::size(angles) * std::size(alphas));
  std::uint64_t stream = 0;
  for (const auto kind : {NormalDistribution::ggx, NormalDistribution::beckmann}) {
    for (const auto& [au, av] : alphas) {
      for (const float cosine : angles) {
        const Vec3f w = at_angle(cosine, 0.9f);
        std::vector<double> seen(rings * sectors, 0), expected(rings * sectors, 0);
        Rng rng(4, Stage::test, stream++);
        for (int i = 0; i < n; ++i) {
          const Vec3f m = sample_visible_normal(kind, w, rng.next_2d(), au, av);
          const Vec3f h = normalize({m.x / au, m.y / av, m.z});
          const double turn = std::atan2(double(h.y), double(h.x)) / (2 * 3.14159265358979324);
          const int ring = std::min(rings - 1, static_cast<int>((1 - h.z) * rings));
          const int sector = std::min(sectors - 1, static_cast<int>((turn - std::floor(turn)) * sectors));
          seen[static_cast<std::size_t>(ring * sectors + sector)] += 1;
        }
        double total = 0;
        for (int r = 0; r < rings * fine; ++r) {
          for (int k = 0; k < sectors * fine; ++k) {
            const double z = 1 - (r + 0.5) / (rings * fine), s = std::sqrt(1 - z * z);
            const double phi = 2 * 3.14159265358979324 * (k + 0.5) / (sectors * fine);
            const Vec3f stretched{static_cast<float>(au * s * std::cos(phi)),
                                  static_cast<float>(av * s * std::sin(phi)), static_cast<float>(z)};
            const double len = length(stretched);
            const double mass = visible_normal_pdf(kind, w, stretched / static_cast<float>(len), au, av) *
                                au * av / (len * len * len) * 2 * 3.14159265358979324 /
                                (rings * fine * sectors * fine);
            expected[static_cast<std::size_t>(r / fine * sectors + k / fine)] += n * mass;
            total += mass;
          }
        }
        EXPECT_NEAR(total, 1, 3e-3) << au << ' ' << av << ' ' << cosine;
        ChiSquareTest chi2;
        for (std::size_t c = 0; c < seen.size(); ++c) chi2.add(seen[c], expected[c]);
        ASSERT_GE(chi2.bins(), 3);
        EXPECT_GT(chi2.tail(), significance)
            << (kind == NormalDistribution::ggx ? "ggx " : "beckmann ") << au << " x " << av << " at "
            << cosine << ": " << chi2.statistic() << " with " << chi2.bins() - 1 << " degrees, " << total;
      }
    }
  }
}

TEST(Interface, TableFollowsTheIntegral) {
  for (const auto kind : {NormalDistribution::beckmann, NormalDistribution::ggx}) {
    for (float eta : {1.1f, 1.33f, 1.49f, 1.9f, 2.6f}) {
      for (float alpha : {0.02f, 0.1f, 0.35f, 0.8f}) {
        const Lobe lobe = interfaced_diffuse_lobe(Rgb(0.5f), eta, kind, alpha, false);
        double diffuse = 0;
        for (int i = 0; i < 20; ++i) {
          const float mu = (static_cast<float>(i) + 0.5f) / 20;
          const double t = interface_means(kind, alpha, eta, mu, 48).transmittance;
          // The stated accuracy of the fit: 0.01, and 0.02 below 6 degrees of elevation.
          EXPECT_NEAR(interface_transmittance(lobe, mu), t, mu > 0.1f ? 0.01 : 0.02)
              << eta << ' ' << alpha << ' ' << mu;
          diffuse += 2 * mu * t / 20;
        }
        EXPECT_NEAR(lobe.alpha_v, diffuse, 0.005) << eta << ' ' << alpha;
      }
    }
  }
}

// What Mitsuba 3.9 gives for roughplastic (Beckmann, index polypropylene, 0.7) over its own smooth plastic,
// light and eye in planes at right angles, where the coating's reflection is nothing.
TEST(Interface, AsMitsuba3IsAsDarkAsThere) {
  const float eta = 1.49f / 1.000277f;
  const Lobe smooth = interfaced_diffuse_lobe(Rgb(0.7f), eta, NormalDistribution::beckmann, 0, false, true);
  const auto value = [](const Lobe& lobe, float in, float out) {
    return lobe.color.r * interface_transmittance(lobe, in) * interface_transmittance(lobe, out);
  };
  struct Case {
    float alpha, of_high, of_low;
  };
  for (const auto& [alpha, of_high, of_low] : {Case{0.03f, 0.9766f, 0.9765f}, Case{0.1f, 0.9613f, 0.9605f}}) {
    const Lobe rough =
        interfaced_diffuse_lobe(Rgb(0.7f), eta, NormalDistribution::beckmann, alpha, false, true);
    EXPECT_NEAR(value(rough, 0.9f, 0.6f) / value(smooth, 0.9f, 0.6f), of_high, 0.006f) << alpha;
    EXPECT_NEAR(value(rough, 0.5f, 0.8f) / value(smooth, 0.5f, 0.8f), of_low, 0.006f) << alpha;
  }
}

// A nearly smooth interface is a smooth one.
TEST(Interface, RoughTendsToSmooth) {
  for (const auto kind : {NormalDistribution::beckmann, NormalDistribution::ggx}) {
    const InterfaceCoefficients rough = interface_coefficients(kind, 1e-4f, 1.5f);
    const InterfaceCoefficients smooth = interface_coefficients(kind, 0, 1.5f);
    EXPECT_NEAR(rough.diffuse_transmittance, smooth.diffuse_transmittance, 2e-3);
    EXPECT_NEAR(rough.internal_reflectance, smooth.internal_reflectance, 2e-3);
  }
}

}  // namespace
}  // namespace lumirank::scatter
