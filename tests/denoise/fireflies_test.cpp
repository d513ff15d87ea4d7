#include "denoise/fireflies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/random.h"

namespace lumirank::denoise {
namespace {

using image::Image;

constexpr int kCalmWidth = 40, kCalmHeight = 30;

struct WithFireflies {
  Image image{kCalmWidth, kCalmHeight, Rgb(0.2f, 0.4f, 0.1f)};
  std::vector<float> deviation = std::vector<float>(image.pixels.size(), 0.01f);

  void set(int x, int y, float times, float deviations) {
    const float usual = luminance(image.at(x, y));
    image.at(x, y) *= times;
    deviation[static_cast<std::size_t>(y * kCalmWidth + x)] = (times - 1) * usual / deviations;
  }
  Image clean() const { return without_fireflies(image, deviation); }
};

TEST(Fireflies, AreAsBrightAsWhatIsAround) {
  WithFireflies s;
  const Image calm = s.image;
  s.set(20, 10, 5, 1.2f);
  s.set(0, 0, 30, 1);
  s.set(21, 12, 3, 2);  // beside another one
  const Image clean = s.clean();
  for (std::size_t p = 0; p < calm.pixels.size(); ++p)
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(clean.pixels[p][c], calm.pixels[p][c], 0.05f) << p;
}

TEST(Fireflies, WhatManySamplesHaveFoundStays) {
  WithFireflies s;
  s.set(20, 10, 5, 4);
  const Image clean = s.clean();
  for (std::size_t p = 0; p < clean.pixels.size(); ++p) ASSERT_EQ(clean.pixels[p], s.image.pixels[p]) << p;
}

TEST(Fireflies, EdgesAndLinesStay) {
  WithFireflies s;
  for (int y = 0; y < kCalmHeight; ++y)
    for (int x = 0; x < kCalmWidth; ++x)
      if (x >= 20 || x == 8 || y == 15) s.set(x, y, 6, 1);
  EXPECT_EQ(s.clean().pixels, s.image.pixels);
}

// Of paths that seldom find a light the mean is right, and all of them are needed for it.
TEST(Fireflies, TheMeanOfMuchNoiseStays) {
  WithFireflies s;
  Rng random(3, Stage::projection, 8);
  for (int y = 0; y < kCalmHeight; ++y)
    for (int x = 0; x < kCalmWidth; ++x)
      if (random.next_float() < 0.05f) s.set(x, y, 10, 1);
  const auto sum = [](const Image& image) {
    double light = 0;
    for (const Rgb& p : image.pixels) light += static_cast<double>(luminance(p));
    return light;
  };
  EXPECT_NEAR(sum(s.clean()) / sum(s.image), 1, 0.01);
}

TEST(Fireflies, RefusesOtherSizes) {
  WithFireflies s;
  s.deviation.pop_back();
  EXPECT_THROW(s.clean(), InternalError);
}

}  // namespace
}  // namespace lumirank::denoise
