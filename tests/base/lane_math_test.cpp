// Transcendental functions in lanes against the library's in double precision.
#include "base/lane_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lumirank {
namespace {

double ulp(double x) { return std::abs(x) * std::numeric_limits<float>::epsilon(); }

TEST(LaneMath, ExponentialWithinTwoUlps) {
  for (float x = 0; x > -87; x = x * 1.003f - 1e-6f)
    ASSERT_NEAR(exp_negative(splat(x))[0], std::exp(static_cast<double>(x)), 2 * ulp(std::exp(x))) << x;
  EXPECT_EQ(exp_negative(splat(-100))[3], 0);
  EXPECT_EQ(exp_negative(splat(0))[3], 1);
}

TEST(LaneMath, LogarithmWithinThreeUlps) {
  for (float x = 1e-37f; x < 1e38f; x *= 1.0037f) {
    const double exact = std::log(static_cast<double>(x));
    ASSERT_NEAR(log_positive(splat(x))[0], exact, 3 * ulp(exact)) << x;
  }
  for (float gap = 1e-7f; gap < 0.5f; gap *= 1.01f) {
    const float x = 1 - gap;
    const double exact = std::log(static_cast<double>(x));
    ASSERT_NEAR(log_positive(splat(x))[0], exact, 3 * ulp(exact)) << x;
  }
  EXPECT_EQ(log_positive(splat(1))[0], 0);
}

TEST(LaneMath, AngleWithinAFewRoundings) {
  for (double angle = 0; angle <= 1.5707; angle += 0.0003) {
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    // 2e-8 of the polynomial, and what the rounded sine and cosine say of the angle.
    ASSERT_NEAR(angle_of(splat(c), splat(s))[0], angle, 3e-8 + 4 * ulp(angle)) << angle;
  }
}

}  // namespace
}  // namespace lumirank
