// No pixel becomes brighter than what is around it; and nothing else changes.
#include "denoise/overshoot.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace lumirank::denoise {
namespace {

constexpr int kLineSide = 32;

// A bright line on dark ground.
image::Image line() {
  image::Image picture(kLineSide, kLineSide, Rgb(0.1f));
  for (int x = 0; x < kLineSide; ++x) picture.at(x, 10) = Rgb{8, 10, 6};
  return picture;
}

TEST(Overshoot, ALineIsNoBrighterThanItWas) {
  image::Image denoised = line();
  for (int x = 0; x < kLineSide; ++x) denoised.at(x, 10) *= 2.5f;
  const image::Image mended = without_overshoot(line(), denoised);
  for (int x = 0; x < kLineSide; ++x)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mended.at(x, 10)[c], line().at(x, 10)[c], 1e-5f) << x;
}

TEST(Overshoot, WhatIsWithinStaysToTheBit) {
  image::Image denoised = line();
  for (int x = 0; x < kLineSide; ++x) denoised.at(x, 10) *= 0.7f, denoised.at(x, 12) = Rgb(5);
  EXPECT_EQ(without_overshoot(line(), denoised).pixels, denoised.pixels);
}

TEST(Overshoot, LightFoundFarAwayMayBeSpreadOverTheDark) {
  // One pixel in some hundred has all the light.
  image::Image rare(kLineSide, kLineSide, Rgb(0));
  for (int k = 0; k < kLineSide; k += 11) rare.at(k, k) = Rgb(30);
  const image::Image even(kLineSide, kLineSide, Rgb(0.1f));
  EXPECT_EQ(without_overshoot(rare, even).pixels, even.pixels);
}

TEST(Overshoot, PicturesOfTwoSizesAreRefused) {
  EXPECT_THROW(without_overshoot(line(), image::Image(kLineSide, 1, Rgb(0))), InternalError);
}

}  // namespace
}  // namespace lumirank::denoise
