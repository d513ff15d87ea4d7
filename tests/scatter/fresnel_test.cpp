// Fresnel factors against closed forms.
#include "scatter/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace lumirank::scatter {
namespace {

TEST(FresnelDielectric, NormalIncidence) {
  for (float n : {1.1f, 1.33f, 1.5f, 2.4f, 0.7f}) {
    const double r = (n - 1) / (n + 1);
    EXPECT_NEAR(fresnel_dielectric(1, n), r * r, 1e-6) << n;
  }
  EXPECT_EQ(fresnel_dielectric(1, 1), 0);
}

// At Brewster's angle tan θ = n the parallel part vanishes, so F is half the perpendicular one: ((n² - 1)/(n²
// + 1))²/2.
TEST(FresnelDielectric, BrewsterAngle) {
  for (double n : {1.33, 1.5, 2.4}) {
    const double c = 1 / std::sqrt(1 + n * n), rs = (n * n - 1) / (n * n + 1);
    EXPECT_NEAR(fresnel_dielectric(static_cast<float>(c), static_cast<float>(n)), 0.5 * rs * rs, 2e-6);
  }
}

TEST(FresnelDielectric, GrazingAndTotalReflection) {
  EXPECT_NEAR(fresnel_dielectric(0, 1.5f), 1, 1e-6);
  // From the dense side the critical cosine is √(1 - 1/n²) = 0.7453560 for n = 1.5.
  EXPECT_EQ(fresnel_dielectric(0.74f, 1 / 1.5f), 1);
  EXPECT_LT(fresnel_dielectric(0.76f, 1 / 1.5f), 0.7f);
  float cos_t = -1;
  fresnel_dielectric(0.5f, 1 / 1.5f, &cos_t);
  EXPECT_EQ(cos_t, 0);
}

// Stokes: the same reflectance from both sides of the interface, and the transmittance is the rest.
TEST(FresnelDielectric, IsTheSameFromBothSides) {
  for (float c = 0.05f; c < 1; c += 0.05f) {
    float cos_t;
    const float f = fresnel_dielectric(c, 1.5f, &cos_t);
    EXPECT_NEAR(fresnel_dielectric(cos_t, 1 / 1.5f), f, 2e-5f);
    EXPECT_NEAR(fresnel_transmittance(c, cos_t, 1.5f), 1 - f, 1e-6f);
    EXPECT_NEAR(fresnel_transmittance(cos_t, c, 1 / 1.5f), 1 - f, 1e-6f);
  }
}

// The amplitude coefficients in complex arithmetic.
double exact_conductor(double c, double eta, double k) {
  const std::complex<double> n(eta, k);
  const std::complex<double> ct = std::sqrt(1.0 - (1 - c * c) / (n * n));
  const auto rs = (c - n * ct) / (c + n * ct), rp = (n * c - ct) / (n * c + ct);
  return 0.5 * (std::norm(rs) + std::norm(rp));
}

TEST(FresnelConductor, MatchesComplexArithmetic) {
  for (double eta : {0.14, 0.9, 1.5, 3.0})
    for (double k : {0.5, 2.4, 6.0})
      for (double c = 0.05; c <= 1; c += 0.05)
        EXPECT_NEAR(fresnel_conductor(static_cast<float>(c), static_cast<float>(eta), static_cast<float>(k)),
                    exact_conductor(c, eta, k), 3e-6);
  // At normal incidence ((η-1)² + k²)/((η+1)² + k²).
  EXPECT_NEAR(fresnel_conductor(1, 0.2f, 3.9f), (0.64 + 15.21) / (1.44 + 15.21), 1e-6);
  // Without loss it is a dielectric.
  EXPECT_NEAR(fresnel_conductor(0.4f, 1.5f, 0), fresnel_dielectric(0.4f, 1.5f), 1e-6f);
  // Mitsuba's "none": a perfect mirror.
  for (float c : {0.0f, 0.01f, 0.3f, 1.0f}) EXPECT_NEAR(fresnel_conductor(c, 0, 1), 1, 1e-6f);
}

TEST(FresnelSchlick, Ends) {
  EXPECT_EQ(fresnel_schlick(1, Rgb(0.04f)), Rgb(0.04f));
  EXPECT_EQ(fresnel_schlick(0, Rgb(0.04f)), Rgb(1));
}

// 2∫F(μ)μ dμ by the midpoint rule in double precision; the part above the critical angle is 1 exactly.
double diffuse_by_quadrature(double eta) {
  double sum = 0;
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double mu = (i + 0.5) / n, t2 = 1 - (1 - mu * mu) / (eta * eta);
    double f = 1;
    if (t2 > 0) {
      const double ct = std::sqrt(t2), p = (eta * mu - ct) / (eta * mu + ct),
                   s = (mu - eta * ct) / (mu + eta * ct);
      f = 0.5 * (p * p + s * s);
    }
    sum += 2 * mu * f;
  }
  return sum / n;
}

TEST(FresnelDiffuse, ClosedFormMatchesQuadrature) {
  for (double eta : {1.003, 1.05, 1.33, 1.49, 2.0, 2.9, 0.9, 1 / 1.33, 1 / 1.49, 0.5})
    EXPECT_NEAR(fresnel_diffuse_reflectance(static_cast<float>(eta)), diffuse_by_quadrature(eta), 2e-5)
        << eta;
  EXPECT_EQ(fresnel_diffuse_reflectance(1), 0);
}

// Sum over all internal reflections: R + T²R(1 + R² + R⁴ + …) = 2R/(1 + R).
TEST(FresnelThin, IsTheSumOfAllReflections) {
  for (double r : {0.0, 0.04, 0.5, 0.99}) {
    double sum = r, inside = (1 - r) * (1 - r) * r;
    for (int i = 0; i < 20000; ++i, inside *= r * r) sum += inside;
    EXPECT_NEAR(fresnel_thin(static_cast<float>(r)), sum, 1e-6);
  }
}

}  // namespace
}  // namespace lumirank::scatter
