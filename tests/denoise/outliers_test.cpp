// Two paths of very many in one pixel, one in either half: no detail, whatever the halves say.
#include <gtest/gtest.h>

#include <vector>

#include "denoise/outliers.h"
#include "denoise/shrinkage.h"

namespace lumirank::denoise {
namespace {

constexpr int kSize = 32;
constexpr std::size_t kDot = 16 * kSize + 16;

// A gray wall of which a denoiser has found the right brightness, and one pixel that is 40 times as bright.
struct Wall {
  image::Image noisy{kSize, kSize, Rgb(0.01f)}, clean{kSize, kSize, Rgb(0.02f)},
      difference{kSize, kSize, Rgb(0.001f)};
  std::vector<float> deviation = std::vector<float>(kSize * kSize, 0.0005f);
  Wall() {
    noisy.pixels[kDot] = Rgb(0.8f);
    difference.pixels[kDot] = Rgb(0);  // as much in both halves
    deviation[kDot] = 0.56f;           // of two paths
  }
  float dot_in(const image::Image& of_halves) const {
    return shrink(noisy, clean, of_halves).picture.pixels[kDot].g;
  }
};

TEST(Outliers, OfTwoPathsDoNotStay) {
  const Wall wall;
  EXPECT_GT(wall.dot_in(wall.difference), 0.4f);
  EXPECT_LT(wall.dot_in(with_outliers(wall.difference, wall.noisy, wall.clean, wall.deviation)), 0.1f);
}

TEST(Outliers, WhatManyPathsFindIsADetail) {
  Wall wall;
  wall.deviation[kDot] = 0.05f;
  const image::Image same = with_outliers(wall.difference, wall.noisy, wall.clean, wall.deviation);
  EXPECT_EQ(same.pixels, wall.difference.pixels);
}

TEST(Outliers, WithoutDeviationsNothingIsSaid) {
  const Wall wall;
  EXPECT_EQ(with_outliers(wall.difference, wall.noisy, wall.clean, {}).pixels, wall.difference.pixels);
}

}  // namespace
}  // namespace lumirank::denoise
