#include "denoise/enlarging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"

namespace lumirank::denoise {
namespace {

using image::Image;

constexpr int kLargeWidth = 96, kLargeHeight = 64;

template <class F>
Image painted(int width, int height, F color) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = color(x, y);
  return image;
}

double mean_difference(const Image& a, const Image& b) {
  double sum = 0, of = 0;
  for (std::size_t p = 0; p < a.pixels.size(); ++p) {
    sum += static_cast<double>(std::abs(a.pixels[p].g - b.pixels[p].g));
    of += static_cast<double>(b.pixels[p].g);
  }
  return sum / of;
}

Image flat(Rgb color) { return Image(kLargeWidth, kLargeHeight, color); }
const Image kNoAlbedo = flat(Rgb(0.5f)), kOneNormal = flat({0, 0, 1});

TEST(Reduced, KeepsTheMean) {
  Rng random(3, Stage::projection, 1);
  const Image image = painted(97, 31, [&](int, int) { return Rgb(random.next_float()); });
  double all = 0;
  for (const Rgb& c : image.pixels)
    all += static_cast<double>(c.g) / static_cast<double>(image.pixels.size());
  for (int divisor : {1, 2, 3, 5}) {
    const Image small = reduced(image, 97 / divisor, 31 / divisor);
    double mean = 0;
    for (const Rgb& c : small.pixels)
      mean += static_cast<double>(c.g) / static_cast<double>(small.pixels.size());
    EXPECT_NEAR(mean, all, 1e-5) << divisor;
  }
  EXPECT_EQ(reduced(image, 97, 31).pixels, image.pixels);
  EXPECT_THROW(reduced(image, 98, 31), InternalError);
}

TEST(Reduced, IsTheMeanOfFourPixels) {
  const Image image = painted(4, 2, [](int x, int y) { return Rgb(static_cast<float>(x + 10 * y)); });
  const Image small = reduced(image, 2, 1);
  EXPECT_FLOAT_EQ(small.at(0, 0).r, 5.5f);
  EXPECT_FLOAT_EQ(small.at(1, 0).r, 7.5f);
}

// Where features say nothing, between centers of pixels light is as on a ramp.
TEST(Enlarged, WithoutFeaturesIsLinear) {
  const auto ramp = [](int scale) {
    return painted(kLargeWidth / scale, kLargeHeight / scale, [scale](int x, int) {
      return Rgb((static_cast<float>(x) + 0.5f) * static_cast<float>(scale));
    });
  };
  const Image large = enlarged(ramp(2), kNoAlbedo, kOneNormal);
  for (int x = 2; x < kLargeWidth - 2; ++x)
    EXPECT_NEAR(large.at(x, 20).g, static_cast<float>(x) + 0.5f, 1e-3f);
}

TEST(Enlarged, OfTheSameSizeIsThePicture) {
  const Image truth =
      painted(kLargeWidth, kLargeHeight, [](int x, int y) { return Rgb(static_cast<float>(x * y % 7)); });
  const Image albedo =
      painted(kLargeWidth, kLargeHeight, [](int x, int y) { return Rgb(static_cast<float>(x + y) / 160); });
  EXPECT_EQ(enlarged(truth, albedo, kOneNormal).pixels, truth.pixels);
}

// A texture of three pixels, of which the small picture has one and a half, under light that changes slowly.
TEST(Enlarged, TexturesComeBack) {
  const Image albedo =
      painted(kLargeWidth, kLargeHeight, [](int x, int y) { return Rgb((x / 3 + y / 3) % 2 ? 0.8f : 0.3f); });
  Image truth = albedo;
  for (int y = 0; y < kLargeHeight; ++y)
    for (int x = 0; x < kLargeWidth; ++x) truth.at(x, y) *= 1 + static_cast<float>(x) / kLargeWidth;
  const Image small = reduced(truth, kLargeWidth / 2, kLargeHeight / 2);
  EXPECT_GT(mean_difference(enlarged(small, kNoAlbedo, kOneNormal), truth), 0.1);
  EXPECT_LT(mean_difference(enlarged(small, albedo, kOneNormal), truth), 0.02);
}

// The corner of a room, one wall of which is lit, not in the middle between pixels of the small picture.
TEST(Enlarged, EdgesOfNormalsComeBack) {
  const auto lit = [](int x, int) { return Rgb(x < 41 ? 1.0f : 0.2f); };
  const Image truth = painted(kLargeWidth, kLargeHeight, lit);
  const Image normal = painted(kLargeWidth, kLargeHeight, [](int x, int) {
    return x < 41 ? Rgb{1, 0, 0} : Rgb{0, 0, 1};
  });
  const Image small = reduced(truth, kLargeWidth / 2, kLargeHeight / 2);
  const double linear = mean_difference(enlarged(small, kNoAlbedo, kOneNormal), truth),
               guided = mean_difference(enlarged(small, kNoAlbedo, normal), truth);
  EXPECT_LT(guided, 0.15 * linear);
}

TEST(Enlarged, SizesNeedNoCommonDivisor) {
  const Image truth = painted(kLargeWidth, kLargeHeight, [](int x, int y) {
    return Rgb(2 + std::sin(static_cast<float>(x) / 9) + std::sin(static_cast<float>(y) / 7));
  });
  const Image small = reduced(truth, 41, 27);
  EXPECT_LT(mean_difference(enlarged(small, kNoAlbedo, kOneNormal), truth), 0.02);
}

// However normals vary, light stays near what is around.
TEST(Enlarged, StaysWithinWhatIsAround) {
  Rng random(5, Stage::projection, 2);
  const Image normal = painted(kLargeWidth, kLargeHeight, [&](int, int) {
    return Rgb{random.next_float(), random.next_float(), random.next_float()};
  });
  const Image small =
      painted(kLargeWidth / 2, kLargeHeight / 2, [&](int x, int) { return Rgb(x < 20 ? 1.0f : 100.0f); });
  const Image large = enlarged(small, kNoAlbedo, normal);
  for (const Rgb& c : large.pixels)
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(c[k], 0.8f - 1e-5f);
      EXPECT_LE(c[k], 125.001f);
    }
}

// The frame of a window, whose light is not a surface's, beside a reveal in which the light falls off: by the
// model alone the frame would be black in places.
TEST(Enlarged, FramesOfWindowsAreNotBlack) {
  // The frame is 0 and 1, the window 2 and on.
  const auto column = [](int x, int y) { return x - 40 - y / 8; };
  const auto choose = [&](auto reveal, Rgb frame) {
    return painted(kLargeWidth, kLargeHeight, [&](int x, int y) {
      return column(x, y) < 0 ? reveal(-column(x, y)) : column(x, y) < 2 ? frame : Rgb(0);
    });
  };
  const auto falling = [](int depth) { return Rgb(std::min(4.0f, 0.3f + static_cast<float>(depth))); };
  const auto sideways = [](int) { return Rgb{1, 0, 0}; };
  const auto gray = [](int) { return Rgb(0.56f); };
  const Image albedo = choose(gray, Rgb(0.56f)), normal = choose(sideways, {0, 0, -1}),
              truth = choose(falling, Rgb(0.25f));
  const Image large = enlarged(reduced(truth, kLargeWidth / 2, kLargeHeight / 2), albedo, normal);
  for (int y = 0; y < kLargeHeight; ++y)
    for (int x = 0; x < kLargeWidth; ++x) {
      if (column(x, y) != 0 && column(x, y) != 1) continue;
      EXPECT_GT(large.at(x, y).g, 0.7f * 0.25f) << x << ' ' << y;
      EXPECT_LT(large.at(x, y).g, 1.3f * 0.25f) << x << ' ' << y;
    }
}

// A table in warm light before a dark front in blue light: however features vary, no pixel has another color
// than these and what lies between them.
TEST(Enlarged, MixturesOfColorsAreOfNoThirdColor) {
  Rng random(7, Stage::projection, 3);
  const Rgb warm{30, 20, 10}, blue{0.2f, 0.3f, 0.6f};
  const Image albedo = painted(kLargeWidth, kLargeHeight, [&](int, int) {
    return Rgb{0.3f + 0.5f * random.next_float(), 0.3f + 0.5f * random.next_float(), 0.4f};
  });
  const Image normal = painted(kLargeWidth, kLargeHeight, [&](int, int y) {
    return y < 31 ? Rgb{0, 1, 0} : Rgb{random.next_float(), 0, random.next_float()};
  });
  const Image small = painted(kLargeWidth / 2, kLargeHeight / 2, [&](int x, int y) {
    const Rgb added(0.05f), light = y < 15 + x % 2 ? warm : blue;
    return light * (reduced(albedo, kLargeWidth / 2, kLargeHeight / 2).at(x, y) + added);
  });
  const Image large = enlarged(small, albedo, normal);
  for (int y = 0; y < kLargeHeight; ++y)
    for (int x = 0; x < kLargeWidth; ++x) {
      const Rgb here = albedo.at(x, y) + Rgb(0.05f), c = large.at(x, y);
      // Red over blue is 3 or 1/3, and tells how much there is of each.
      const float red = c.r / here.r / (c.b / here.b), green = c.g / here.g / (c.b / here.b);
      EXPECT_GT(red, 0.333f) << x << ' ' << y;
      EXPECT_LT(red, 3.003f) << x << ' ' << y;
      const float part = (red * blue.b - blue.r) / (warm.r - blue.r - red * (warm.b - blue.b));
      const Rgb mixed = warm * part + blue * (1 - part);
      EXPECT_NEAR(green, mixed.g / mixed.b, 0.01f) << x << ' ' << y;
    }
}

TEST(Enlarged, RefusesFeaturesOfOtherSizes) {
  EXPECT_THROW(enlarged(Image(8, 8), Image(16, 16), Image(16, 8)), InternalError);
  EXPECT_THROW(enlarged(Image(32, 8), Image(16, 16), Image(16, 16)), InternalError);
}

}  // namespace
}  // namespace lumirank::denoise
