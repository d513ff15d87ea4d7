#include "pipeline/picture_mean.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace lumirank::pipeline {
namespace {

TEST(PictureMean, IsThatOfAllPictures) {
  PictureMean mean;
  EXPECT_TRUE(mean.mean().pixels.empty());
  for (int k = 1; k <= 3; ++k) mean.add(image::Image(2, 1, Rgb(static_cast<float>(k))));
  EXPECT_EQ(mean.count(), 3u);
  EXPECT_NEAR(mean.mean().at(1, 0).g, 2, 1e-6f);
}

// Pictures of 1 with Gaussian noise σ: the mean of n is off by σ √(2/π / n) on average, whether halves are
// of equal size or not.
TEST(PictureMean, StatesTheNoiseOfTheMean) {
  for (const int count : {2, 3, 8, 9}) {
    PictureMean mean;
    for (int k = 0; k < count; ++k) {
      Rng rng(1, Stage::test, static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(count));
      image::Image picture(100, 100);
      for (Rgb& p : picture.pixels)
        for (int c = 0; c < 3; ++c) p[c] = 1 + 0.2f * static_cast<float>(rng.next_gaussian());
      mean.add(picture);
    }
    double off = 0;
    for (const Rgb& p : mean.mean().pixels)
      for (int c = 0; c < 3; ++c) off += std::abs(static_cast<double>(p[c]) - 1) / 30000;
    EXPECT_NEAR(mean.noise(), off, 0.03 * off) << count;
    double twice = 0;
    for (const Rgb& p : mean.difference().pixels)
      for (int c = 0; c < 3; ++c) twice += std::abs(static_cast<double>(p[c])) / 30000;
    EXPECT_NEAR(twice / 2, off, 0.03 * off) << count;
    EXPECT_NEAR(off, 0.2 * std::sqrt(2 / 3.14159265 / count), 0.03 * off);
  }
}

// Pictures of few samples count for less, and the noise is stated for that.
TEST(PictureMean, WeighsByVariance) {
  PictureMean mean, equal;
  const double weights[] = {1, 0.25, 1.5, 0.25};
  for (std::uint64_t k = 0; k < 4; ++k) {
    Rng rng(2, Stage::test, k);
    image::Image picture(200, 100);
    const auto deviation = static_cast<float>(0.2 / std::sqrt(weights[k]));
    for (Rgb& p : picture.pixels)
      for (int c = 0; c < 3; ++c) p[c] = 1 + deviation * static_cast<float>(rng.next_gaussian());
    mean.add(picture, weights[k]), equal.add(picture);
  }
  const auto off = [](const PictureMean& m) {
    double sum = 0;
    for (const Rgb& p : m.mean().pixels)
      for (int c = 0; c < 3; ++c) sum += std::abs(static_cast<double>(p[c]) - 1) / 60000;
    return sum;
  };
  EXPECT_NEAR(off(mean), 0.2 * std::sqrt(2 / 3.14159265 / 3), 0.02 * off(mean));
  EXPECT_NEAR(mean.noise(), off(mean), 0.03 * off(mean));
  EXPECT_GT(off(equal), 1.3 * off(mean));
}

// Pictures of a quarter of the pixels each: what others have there is not theirs.
TEST(PictureMean, IsOfThePixelsThatPicturesHave) {
  PictureMean mean;
  const auto add = [&](int part, float value) {
    const film::PixelLattice pixels = film::interleaved(2, part);
    image::Image picture(5, 3);
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 5; ++x)
        if (pixels.has(x, y)) picture.at(x, y) = Rgb(value);
    mean.add(picture, 1, pixels);
  };
  for (int part = 0; part < 4; ++part) add(part, 1);
  EXPECT_EQ(mean.noise(), 0);
  for (const Rgb& p : mean.mean().pixels) EXPECT_EQ(p, Rgb(1));
  add(0, 2);
  EXPECT_EQ(mean.mean().at(2, 2), Rgb(1.5f));
  EXPECT_EQ(mean.mean().at(1, 1), Rgb(1));
  EXPECT_EQ(mean.difference().at(2, 2), Rgb(-1));
  EXPECT_EQ(mean.difference().at(1, 1), Rgb(0));
  EXPECT_NEAR(mean.noise(), 1.0 / 3, 1e-6) << "of the pixels that two have shown";
}

TEST(PictureMean, NothingIsKnownOfOnePicture) {
  PictureMean mean;
  mean.add(image::Image(2, 2, Rgb(1)));
  EXPECT_EQ(mean.noise(), 0);
}

}  // namespace
}  // namespace lumirank::pipeline
