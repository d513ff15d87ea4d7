#include "denoise/turning.h"

#include <gtest/gtest.h>

#include <vector>

namespace lumirank::denoise {
namespace {

using image::Image;

// 0 1 2
// 3 4 5
Image numbered() {
  Image image(3, 2);
  for (int p = 0; p < 6; ++p) image.pixels[static_cast<std::size_t>(p)] = Rgb(static_cast<float>(p));
  return image;
}

void expect_rows(const Image& image, int width, const std::vector<int>& numbers) {
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.pixels.size(), numbers.size());
  for (std::size_t p = 0; p < numbers.size(); ++p)
    EXPECT_EQ(image.pixels[p], Rgb(static_cast<float>(numbers[p]))) << p;
}

TEST(Turning, QuarterTurnsGoClockwise) {
  expect_rows(turned(numbered(), 0), 3, {0, 1, 2, 3, 4, 5});
  expect_rows(turned(numbered(), 1), 2, {3, 0, 4, 1, 5, 2});
  expect_rows(turned(numbered(), 2), 3, {5, 4, 3, 2, 1, 0});
  expect_rows(turned(numbered(), 3), 2, {2, 5, 1, 4, 0, 3});
}

TEST(Turning, FourAreNoneAndNegativeOnesGoBack) {
  for (int quarters = -5; quarters < 6; ++quarters) {
    EXPECT_EQ(turned(turned(numbered(), quarters), -quarters).pixels, numbered().pixels) << quarters;
    EXPECT_EQ(turned(numbered(), quarters).pixels, turned(numbered(), quarters + 4).pixels) << quarters;
  }
}

}  // namespace
}  // namespace lumirank::denoise
