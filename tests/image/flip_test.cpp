// FLIP against the program of its authors, and what follows from its definition.
#include "image/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "base/parallel.h"
#include "image/metrics.h"
#include "image/on_screen.h"

namespace lumirank::image {
namespace {

// Colored squares over a ramp that wraps around: edges, smooth parts and all hues, in 128ths.
int truth_at(int x, int y, int c) { return ((x / 8 + y / 8) % 2 * (3 - c) * 16 + (c + 1) * x / 2 + y) % 128; }
int noisy_at(int x, int y, int c) {
  return std::clamp(truth_at(x, y, c) + (37 * x + 91 * y + 53 * c) % 29 - 14, 0, 127);
}

Image made(const std::function<float(int, int, int)>& value) {
  Image image(96, 64);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = value(x, y, c);
  return image;
}
Image truth() {
  return made([](int x, int y, int c) { return static_cast<float>(truth_at(x, y, c)) / 128; });
}
Image noisy() {
  return made([](int x, int y, int c) { return static_cast<float>(noisy_at(x, y, c)) / 128; });
}

// The constants are printed by tests/image/flip_constants.py, which makes the same pictures and gives them,
// sRGB-encoded, to the authors' package flip-evaluator 1.7. The filters are sums in single precision, here in
// another order than there.
TEST(Flip, AgreesWithItsAuthorsProgram) {
  constexpr double kTolerance = 2e-5;
  const Image shifted =
      made([](int x, int y, int c) { return static_cast<float>(truth_at(std::min(x + 1, 95), y, c)) / 128; });
  const Image cast = made([](int x, int y, int c) {
    return static_cast<float>(truth_at(x, y, c)) / 128 * (1 - 0.25f * static_cast<float>(c));
  });
  EXPECT_NEAR(flip_error(noisy(), truth()), 0.0778981, kTolerance);
  EXPECT_NEAR(flip_error(shifted, truth()), 0.2146363, kTolerance);
  EXPECT_NEAR(flip_error(cast, truth()), 0.5226138, kTolerance);
  EXPECT_NEAR(flip_error(noisy(), truth(), 25), 0.2393132, kTolerance);
  EXPECT_NEAR(flip_error(noisy(), truth(), 150), 0.0417115, kTolerance);
}

// The tone map included; compare() is what `lumirank error` prints.
TEST(Flip, OfRadianceAgreesToo) {
  const auto squared = [](int v) { return 8 * static_cast<float>(v * v) / (128 * 128); };
  const Image reference = made([&](int x, int y, int c) { return squared(truth_at(x, y, c)); });
  const Image image = made([&](int x, int y, int c) { return squared(noisy_at(x, y, c)); });
  EXPECT_NEAR(compare(image, reference).flip, 0.0713736, 2e-5);
}

TEST(Flip, IsZeroOfOnePictureAndOneOfGreenAndBlue) {
  EXPECT_EQ(flip_error(truth(), truth()), 0);
  // They differ most among all colors of sRGB: the measure is scaled by them.
  EXPECT_NEAR(flip_error(Image(20, 9, {0, 1, 0}), Image(20, 9, {0, 0, 1})), 1, 1e-5);
  EXPECT_EQ(flip_error(Image(1, 1, Rgb(0.5f)), Image(1, 1, Rgb(0.5f))), 0);
  EXPECT_EQ(flip_error(noisy(), truth()), flip_error(truth(), noisy()));
}

TEST(Flip, SameBitsForAnyNumberOfThreads) {
  double one = 0, four = 0;
  with_threads(1, [&] { one = flip_error(noisy(), truth()); });
  with_threads(4, [&] { four = flip_error(noisy(), truth()); });
  EXPECT_EQ(one, four);
}

TEST(Flip, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(flip_error(Image(2, 3), Image(3, 2)), InputError);
  EXPECT_THROW(flip_error(Image(), Image()), InputError);
}

// Channels 0 0 1 1 2 4: the median is 1. With a seventh to ninth of 8: 0 0 1 1 2 4 8 8 8, the median is 2.
TEST(OnScreen, TheMedianIsExposedToAQuarter) {
  Image even(2, 1), odd(3, 1);
  even.pixels = {{4, 0, 1}, {1, 2, 0}};
  odd.pixels = {{4, 0, 1}, {1, 2, 0}, {8, 8, 8}};
  EXPECT_DOUBLE_EQ(exposure_for(even), 0.245);
  EXPECT_DOUBLE_EQ(exposure_for(odd), 0.245 / 2);
  even.pixels[1] = {3, 5, 2};  // 0 1 2 3 4 5
  EXPECT_DOUBLE_EQ(exposure_for(even), 0.245 / 2.5);
}

TEST(OnScreen, MostlyBlackPicturesAreExposedByTheRest) {
  Image small(4, 1);
  small.pixels[2] = {-1, 2, 4};
  EXPECT_DOUBLE_EQ(exposure_for(small), 0.245 / 3);
  // Whatever is beside a black reference is as bright as can be.
  const Image black(4, 1);
  EXPECT_TRUE(std::isinf(exposure_for(black)));
  EXPECT_EQ(on_screen(small, exposure_for(black)).pixels[2], Rgb(0, 1, 1));
  EXPECT_EQ(compare(black, black).flip, 0);
  EXPECT_GT(compare(small, black).flip, 0.1);
  EXPECT_LE(compare(small, black).flip, 1);
}

// x = 1, 4 and 1000 times: 1.25/2, 1.25·4/5 = 1, more than 1; and nothing below 0.
TEST(OnScreen, Curve) {
  Image image(2, 1);
  image.pixels = {{0.5f, 2, 500}, {0, -3, 0.125f}};
  const Image shown = on_screen(image, 2);
  EXPECT_EQ(shown.pixels[0], Rgb(0.625f, 1, 1));
  EXPECT_EQ(shown.pixels[1], Rgb(0, 0, 0.25f));
}

}  // namespace
}  // namespace lumirank::image
