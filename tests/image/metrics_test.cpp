#include "image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/vec.h"
#include "image/false_color.h"

namespace lumirank::image {
namespace {

// Two pixels. Reference: 1 1 1, 3 3 3 (sum 12, squares 30, mean 2). Differences: +1 0 0, 0 -2 0.
// Σ|d| = 3, Σd = -1, Σd² = 5. relmse = (1/(1 + 1e-4·4) + 4/(9 + 1e-4·4)) / 6.
TEST(Metrics, DerivedByHand) {
  Image reference(2, 1), image(2, 1);
  reference.pixels = {{1, 1, 1}, {3, 3, 3}};
  image.pixels = {{2, 1, 1}, {3, 1, 3}};
  const PictureError m = compare(image, reference);
  EXPECT_DOUBLE_EQ(m.relative_l1, 3.0 / 12);
  EXPECT_DOUBLE_EQ(m.relative_l2, std::sqrt(5.0 / 30));
  EXPECT_DOUBLE_EQ(m.rmse, std::sqrt(5.0 / 6));
  EXPECT_DOUBLE_EQ(m.relmse, (1 / 1.0004 + 4 / 9.0004) / 6);
  EXPECT_DOUBLE_EQ(m.bias, -1.0 / 12);
}

TEST(Metrics, SameImageHasNoError) {
  const Image image(100, 100, Rgb(0.1f, 3, 20));
  const PictureError m = compare(image, image);
  EXPECT_EQ(m.relative_l1, 0);
  EXPECT_EQ(m.relative_l2, 0);
  EXPECT_EQ(m.rmse, 0);
  EXPECT_EQ(m.relmse, 0);
  EXPECT_EQ(m.bias, 0);
  EXPECT_EQ(m.flip, 0);
}

// A power of two, so that all roundings scale too.
TEST(Metrics, AllButRmseDoNotDependOnTheUnit) {
  Image image(40, 30), reference(40, 30);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    reference.pixels[i] = Rgb(static_cast<float>(i % 89) / 3, 1, 2);
    image.pixels[i] = reference.pixels[i] * (0.5f + static_cast<float>(i % 7) / 6);
  }
  const PictureError as_it_is = compare(image, reference);
  for (Image* each : {&image, &reference})
    for (Rgb& c : each->pixels) c *= 0x1p-20f;
  const PictureError scaled = compare(image, reference);
  EXPECT_EQ(scaled.relative_l1, as_it_is.relative_l1);
  EXPECT_EQ(scaled.relative_l2, as_it_is.relative_l2);
  EXPECT_EQ(scaled.relmse, as_it_is.relmse);
  EXPECT_EQ(scaled.bias, as_it_is.bias);
  EXPECT_EQ(scaled.flip, as_it_is.flip);
  EXPECT_EQ(scaled.rmse, 0x1p-20 * as_it_is.rmse);
  EXPECT_GT(as_it_is.flip, 0);
}

TEST(Metrics, BlackReference) {
  const Image black(2, 2);
  EXPECT_EQ(compare(black, black).relative_l1, 0);
  EXPECT_TRUE(std::isinf(compare(Image(2, 2, Rgb(1)), black).relative_l1));
}

TEST(Metrics, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(compare(Image(2, 3), Image(3, 2)), InputError);
  EXPECT_THROW(compare(Image(), Image()), InputError);
  Image image(40, 40, Rgb(1)), reference(40, 40, Rgb(1));
  image.at(3, 3).g = std::nanf("");
  image.at(4, 3) = Rgb(kInfinity);  // three values, one pixel
  reference.at(39, 39).b = -kInfinity;
  try {
    compare(image, reference);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "NaN or infinite pixels: 2 in the image, 1 in the reference");
  }
}

TEST(Metrics, SameBitsForAnyNumberOfThreads) {
  Image image(300, 300), reference(300, 300);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = Rgb(static_cast<float>(i % 97) / 7);
    reference.pixels[i] = Rgb(static_cast<float>(i % 89) / 3, 1, 2);
  }
  PictureError one, four;
  with_threads(1, [&] { one = compare(image, reference); });
  with_threads(4, [&] { four = compare(image, reference); });
  EXPECT_EQ(one.relative_l1, four.relative_l1);
  EXPECT_EQ(one.relative_l2, four.relative_l2);
  EXPECT_EQ(one.relmse, four.relmse);
  EXPECT_EQ(one.bias, four.bias);
  EXPECT_EQ(one.flip, four.flip);
}

// Reference mean 2, differences 0, 0.5 and 2 in every channel: 0, 0.25 and 1 of the mean; with full = 0.5
// that is 0, half and (clamped) all of the map.
TEST(FalseColor, ErrorsRelativeToTheMean) {
  const Image reference(3, 1, Rgb(2));
  Image image = reference;
  image.pixels[1] = Rgb(2.5f);
  image.pixels[2] = Rgb(0);
  const Image colors = false_color_error(image, reference, 0.5f);
  EXPECT_EQ(colors.pixels[0], false_color(0));
  EXPECT_EQ(colors.pixels[1], false_color(0.5f));
  EXPECT_EQ(colors.pixels[2], false_color(1));
  image.pixels[0].r = std::nanf("");
  EXPECT_EQ(false_color_error(image, reference).pixels[0], Rgb(1, 0, 1));
  EXPECT_THROW(false_color_error(Image(1, 1), reference), InputError);
}

float oklab_lightness(Rgb c) {
  const float l = 0.4122214708f * c.r + 0.5363325363f * c.g + 0.0514459929f * c.b;
  const float m = 0.2119034982f * c.r + 0.6806995451f * c.g + 0.1073969566f * c.b;
  const float s = 0.0883024619f * c.r + 0.2817188376f * c.g + 0.6299787005f * c.b;
  return 0.2104542553f * std::cbrt(l) + 0.7936177850f * std::cbrt(m) - 0.0040720468f * std::cbrt(s);
}

// The lightness only comes out linear if no color of the map had to be clipped into the gamut.
TEST(FalseColor, LightnessIsLinearAndInsideTheGamut) {
  for (int i = 0; i <= 100; ++i) {
    const float t = static_cast<float>(i) / 100;
    const Rgb c = false_color(t);
    EXPECT_NEAR(oklab_lightness(c), 0.20f + 0.72f * t, 1e-4f) << t;
    EXPECT_TRUE(c.r > 0 && c.g > 0 && c.b > 0 && max_component(c) < 1) << t;
  }
  EXPECT_GT(false_color(0).b, false_color(0).r);
  EXPECT_GT(false_color(1).r, false_color(1).b);
  EXPECT_EQ(false_color(-1), false_color(0));
  EXPECT_EQ(false_color(9), false_color(1));
  const Image bar = color_bar(10, 2);
  EXPECT_EQ(bar.at(0, 1), false_color(0.05f));
  EXPECT_EQ(bar.at(9, 0), false_color(0.95f));
}

}  // namespace
}  // namespace lumirank::image
