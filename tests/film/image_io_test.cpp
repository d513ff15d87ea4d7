#include "film/image_io.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "film/pfm.h"
#include "film/temporary_folder.h"

namespace lumirank::film {
namespace {

// Values of many magnitudes, none of them special in any format.
Image pattern(int width, int height, float seed) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = {seed + static_cast<float>(x) / 7.0f, std::exp2(static_cast<float>(y - x)),
                        1e-3f * static_cast<float>(1 + x * y)};
  return image;
}

void expect_same_bits(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c)
      ASSERT_EQ(std::bit_cast<std::uint32_t>(a.pixels[i][c]), std::bit_cast<std::uint32_t>(b.pixels[i][c])) << i;
}

class ImageIo : public TemporaryFolder {};

TEST_F(ImageIo, FloatFormatsComeBackBitForBit) {
  Image image = pattern(13, 9, 0.25f);
  image.at(3, 2) = {-1.5f, 0.0f, std::numeric_limits<float>::denorm_min()};
  image.at(4, 2) = {1e30f, std::numeric_limits<float>::infinity(), -0.0f};
  for (const char* name : {"a.exr", "a.pfm", "A.EXR"}) {
    write_image(path(name), {image, {}});
    const LoadedImage loaded = read_image(path(name));
    expect_same_bits(loaded.color, image);
    EXPECT_TRUE(loaded.alpha.empty());
  }
  EXPECT_EQ(files().size(), 3u) << "no temporary file is left";
}

}  // namespace
}  // namespace lumirank::film
