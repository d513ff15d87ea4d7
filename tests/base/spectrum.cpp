#include "base/spectrum.h"

#include <gtest/gtest.h>

namespace lumirank {
namespace {

SampledSpectrum constant(float value) { return {{360, 830}, {value, value}}; }

TEST(Spectrum, AConstantReflectanceIsGray) {
  const Rgb c = reflectance_to_rgb(constant(0.78f));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(c[i], 0.78f, 1e-6f);
}

// Equal energy is XYZ = (1, 1, 1) up to the rounding of the tables (1e-3); the rows of XYZ → Rec. 709 add up
// to these.
TEST(Spectrum, EqualEnergyEmissionIsTheSumOfTheMatrixRows) {
  const Rgb c = emission_to_rgb(constant(1));
  EXPECT_NEAR(c.r, 3.2404542 - 1.5371385 - 0.4985314, 2e-3);
  EXPECT_NEAR(c.g, -0.9692660 + 1.8760108 + 0.0415560, 2e-3);
  EXPECT_NEAR(c.b, 0.0556434 - 0.2040259 + 1.0572252, 2e-3);
  EXPECT_NEAR(luminance(c), 1, 1e-3);
}

TEST(Spectrum, IsZeroOutsideItsSamplesAndLinearBetween) {
  const SampledSpectrum s{{400, 500}, {1, 3}};
  EXPECT_EQ(s.at(399), 0);
  EXPECT_EQ(s.at(400), 1);
  EXPECT_EQ(s.at(450), 2);
  EXPECT_EQ(s.at(500), 3);
  EXPECT_EQ(s.at(501), 0);
}

// Wien: λ_max · T = 2.897771955e-3 m K; Stefan-Boltzmann: ∫ L dλ = σT⁴/π.
TEST(Spectrum, PlanckObeysWienAndStefanBoltzmann) {
  const double kelvin = 5000, peak = 2.897771955e6 / kelvin;
  EXPECT_GT(planck(peak, kelvin), planck(peak * 1.001, kelvin));
  EXPECT_GT(planck(peak, kelvin), planck(peak * 0.999, kelvin));
  double sum = 0;
  for (int nm = 50; nm < 100000; ++nm) sum += planck(nm + 0.5, kelvin);
  // The tail beyond 100 µm is below 2e-6 of the whole.
  EXPECT_NEAR(sum / (5.670374419e-8 * kelvin * kelvin * kelvin * kelvin / 3.14159265358979), 1, 1e-4);
}

TEST(Spectrum, HotterBlackbodiesAreBrighterAndBluer) {
  const Rgb warm = blackbody_to_rgb(3000), cool = blackbody_to_rgb(9000);
  EXPECT_GT(luminance(cool), luminance(warm));
  EXPECT_GT(warm.r, warm.b);
  EXPECT_GT(cool.b, cool.r);
}

TEST(Spectrum, SrgbDecoding) {
  EXPECT_EQ(srgb_to_linear(Rgb(0)), Rgb(0));
  EXPECT_NEAR(srgb_to_linear(Rgb(1)).r, 1, 1e-6);
  EXPECT_NEAR(srgb_to_linear(Rgb(0.5f)).r, 0.21404114, 1e-6);  // ((0.5 + 0.055)/1.055)^2.4
}

}  // namespace
}  // namespace lumirank
