#include "emitters/daylight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "emitters/hosek_wilkie.h"

namespace lumirank::emitters {
namespace {

Vec3f at_zenith_angle(double theta, double azimuth = 0) {
  return {static_cast<float>(std::sin(theta) * std::cos(azimuth)), static_cast<float>(std::cos(theta)),
          static_cast<float>(std::sin(theta) * std::sin(azimuth))};
}

constexpr double kCandelasPerUnit = 683 * 106.857;

// Against what Mitsuba 3.9.1 says of its own.
TEST(Sky, IsMitsubas) {
  struct Case {
    float turbidity, albedo;
    Vec3f sun, direction;
    Rgb radiance;
  };
  const Case cases[] = {
      {3, 0.3f, {0.35f, 0.85f, 0.2f}, {0, 0.3f, -1}, {0.06393553f, 0.10980947f, 0.18976717f}},
      {3, 0.3f, {0.35f, 0.85f, 0.2f}, {1, 0.05f, 0}, {0.16061795f, 0.22107169f, 0.2902252f}},
      {3, 0.3f, {0.9f, 0.1f, 0.1f}, {1, 0.05f, 0}, {0.5856726f, 0.37738895f, 0.12339173f}},
      {2.5f, 0.7f, {0.2f, 0.4f, 0.6f}, {0, 0.3f, 1}, {0.16163515f, 0.2172339f, 0.2786944f}},
      {6.3f, 0.1f, {0, 1, 0}, {0.5f, 0.5f, 0.5f}, {0.06229996f, 0.08762127f, 0.12680382f}},
  };
  for (const Case& c : cases) {
    const HosekWilkieSky sky(c.turbidity, Rgb(c.albedo), normalize(c.sun));
    const Rgb radiance = sky.radiance(normalize(c.direction));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(radiance[k] / c.radiance[k], 1, 1e-4) << c.turbidity;
  }
}

TEST(Sky, IsBlueAboveBrightestNearTheSunAndBlackBelow) {
  const Vec3f sun = at_zenith_angle(0.9);
  const HosekWilkieSky sky(3, Rgb(0.3f), sun);
  const Rgb zenith = sky.radiance({0, 1, 0}), beside = sky.radiance(at_zenith_angle(0.85));
  const Rgb away = sky.radiance(at_zenith_angle(0.5, 3.14159265));
  EXPECT_GT(zenith.b, zenith.r);
  EXPECT_GT(luminance(beside), 2 * luminance(away));
  EXPECT_TRUE(is_black(sky.radiance({0.6f, -0.8f, 0})));
  for (double theta = 0; theta < 1.57; theta += 0.05)
    for (double azimuth = 0; azimuth < 6.28; azimuth += 0.2) {
      const Rgb c = sky.radiance(at_zenith_angle(theta, azimuth));
      EXPECT_TRUE(is_finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0);
    }
}

TEST(Sun, ExtinctionGrowsAndReddensTowardsTheHorizon) {
  double last = 1e30, last_ratio = 0;
  for (const float theta : {0.0f, 0.5f, 1.0f, 1.3f, 1.5f}) {
    const Rgb sun = sun_radiance(3, theta);
    EXPECT_LT(luminance(sun), last);
    last = luminance(sun);
    const double ratio = sun.r / std::max(sun.b, 1e-20f);
    EXPECT_GT(ratio, last_ratio);
    last_ratio = ratio;
  }
  EXPECT_LT(luminance(sun_radiance(8, 0.5f)), luminance(sun_radiance(2, 0.5f)));
}

// Irradiance over π under Mitsuba 3.9.1's sun of turbidities 1, 3 and 6, in four digits.
TEST(Sun, IsMitsubas) {
  struct Case {
    float turbidity, degrees;
    Rgb over_pi;
  };
  const Case cases[] = {{1, 85, {0.4939f, 0.4193f, 0.3310f}},
                        {3, 60, {0.4132f, 0.3460f, 0.2665f}},
                        {3, 15, {0.0968f, 0.0666f, 0.0323f}},
                        {6, 35, {0.2288f, 0.1810f, 0.1269f}}};
  for (const Case& c : cases) {
    const float elevation = c.degrees * kPi / 180, sine = std::sin(kSunHalfAngle);
    const Rgb over_pi = hosek_wilkie_sun(c.turbidity, elevation) * (sine * sine * std::sin(elevation));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(over_pi[k] / c.over_pi[k], 1, 0.01) << c.degrees;
  }
}

TEST(Sun, IlluminanceUnderAClearSkyIsInTheMeasuredRange) {
  // Direct sunlight at noon gives about 60 to 110 klx: the disc's luminance times its solid angle.
  const double solid_angle = 3.14159265358979 * std::pow(std::sin(kSunHalfAngle), 2);
  const double lux = luminance(sun_radiance(3, 0.3f)) * kCandelasPerUnit * solid_angle;
  EXPECT_GT(lux, 60e3);
  EXPECT_LT(lux, 110e3);
}

}  // namespace
}  // namespace lumirank::emitters
