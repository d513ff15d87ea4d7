#include "emitters/daylight.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumirank::emitters {
namespace {

Vec3f at_zenith_angle(double theta, double azimuth = 0) {
  return {static_cast<float>(std::sin(theta) * std::cos(azimuth)), static_cast<float>(std::cos(theta)),
          static_cast<float>(std::sin(theta) * std::sin(azimuth))};
}

constexpr double kCandelasPerUnit = 683 * 106.857;

TEST(Sky, ZenithLuminanceIsThatOfThePaper) {
  // Equation of appendix A.2: Yz = (4.0453 T - 4.9710) tan((4/9 - T/120)(π - 2θs)) - 0.2155 T + 2.4192
  // kcd/m².
  for (const double turbidity : {2.0, 3.0, 6.0})
    for (const double theta : {0.2, 0.8, 1.3}) {
      const double chi = (4.0 / 9 - turbidity / 120) * (3.14159265358979 - 2 * theta);
      const double zenith = (4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
      const PreethamSky sky(static_cast<float>(turbidity), at_zenith_angle(theta));
      // Rgb's luminance weights are rounded to four digits.
      EXPECT_NEAR(luminance(sky.radiance({0, 1, 0})) * kCandelasPerUnit / (1000 * zenith), 1, 1e-3);
    }
}

TEST(Sky, IsBlueAboveBrightestNearTheSunAndBlackBelow) {
  const Vec3f sun = at_zenith_angle(0.9);
  const PreethamSky sky(3, sun);
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

TEST(Sun, IlluminanceUnderAClearSkyIsInTheMeasuredRange) {
  // Direct sunlight at noon gives about 60 to 110 klx: the disc's luminance times its solid angle.
  const double solid_angle = 3.14159265358979 * std::pow(std::sin(kSunHalfAngle), 2);
  const double lux = luminance(sun_radiance(3, 0.3f)) * kCandelasPerUnit * solid_angle;
  EXPECT_GT(lux, 60e3);
  EXPECT_LT(lux, 110e3);
}

}  // namespace
}  // namespace lumirank::emitters
