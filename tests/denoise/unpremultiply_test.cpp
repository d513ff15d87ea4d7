// The light of surfaces that cover parts of pixels, told from how much they cover.
#include "denoise/unpremultiply.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"

namespace lumirank::denoise {
namespace {

// Neither is a power of two.
constexpr int kFilmWidth = 45, kFilmHeight = 22;

image::Image random_cover(float share_of_empty) {
  Rng rng(3, Stage::test);
  image::Image cover(kFilmWidth, kFilmHeight);
  for (Rgb& c : cover.pixels) c = Rgb(rng.next_float() < share_of_empty ? 0.0f : rng.next_float());
  return cover;
}

TEST(Unpremultiply, EvenLightIsEvenWhateverCoversIt) {
  const Rgb light{2, 0.5f, 7};
  for (const float share_of_empty : {0.0f, 0.5f, 0.98f}) {
    const image::Image cover = random_cover(share_of_empty);
    image::Image picture(kFilmWidth, kFilmHeight, light);
    premultiply(picture, cover);
    for (const Rgb& p : unpremultiplied(picture, cover).pixels)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(p[c], light[c], 1e-4f * light[c]) << share_of_empty;
  }
}

TEST(Unpremultiply, WhereHalfIsCoveredItIsExact) {
  Rng rng(4, Stage::test);
  const image::Image cover = random_cover(0.3f);
  image::Image picture(kFilmWidth, kFilmHeight);
  for (std::size_t p = 0; p < picture.pixels.size(); ++p)
    picture.pixels[p] = rng.next_float() * cover.pixels[p];
  image::Image again = unpremultiplied(picture, cover);
  premultiply(again, cover);
  for (std::size_t p = 0; p < picture.pixels.size(); ++p)
    if (cover.pixels[p].r >= 0.5f) {
      EXPECT_NEAR(again.pixels[p].g, picture.pixels[p].g, 1e-6f);
    }
}

// A bar of a third of a pixel before a window, left to a dark wall and right to a bright one.
TEST(Unpremultiply, WhatIsHardlyCoveredIsLikeWhatIsBeside) {
  image::Image cover(kFilmWidth, kFilmHeight, Rgb(0)), picture = cover;
  const int bar = 20;
  for (int y = 0; y < kFilmHeight; ++y) {
    cover.at(0, y) = Rgb(1), picture.at(0, y) = Rgb(0.1f);
    cover.at(kFilmWidth - 1, y) = Rgb(1), picture.at(kFilmWidth - 1, y) = Rgb(5);
    cover.at(bar, y) = Rgb(1 / 3.0f), picture.at(bar, y) = Rgb(1 / 3.0f);
  }
  const image::Image light = unpremultiplied(picture, cover);
  const int y = kFilmHeight / 2;
  // Near each its own light.
  EXPECT_FLOAT_EQ(light.at(0, y).g, 0.1f);
  EXPECT_FLOAT_EQ(light.at(kFilmWidth - 1, y).g, 5);
  EXPECT_NEAR(light.at(bar, y).g, 1, 0.1f);
  EXPECT_LT(light.at(2, y).g, 0.3f);
  EXPECT_GT(light.at(kFilmWidth - 3, y).g, 3.5f);
  for (const Rgb& p : light.pixels) EXPECT_TRUE(p.g >= 0.0999f && p.g <= 5.0001f) << p.g;
}

TEST(Unpremultiply, OfNothingIsNothing) {
  const image::Image empty(kFilmWidth, kFilmHeight, Rgb(0));
  EXPECT_EQ(unpremultiplied(empty, empty).pixels, empty.pixels);
}

TEST(Unpremultiply, SizesMustAgree) {
  image::Image picture(4, 4, Rgb(1));
  EXPECT_THROW((void)unpremultiplied(picture, image::Image(4, 3, Rgb(1))), InternalError);
  EXPECT_THROW(premultiply(picture, image::Image(3, 4, Rgb(1))), InternalError);
}

}  // namespace
}  // namespace lumirank::denoise
