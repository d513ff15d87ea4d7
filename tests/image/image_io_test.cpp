#include "image/image_io.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/error.h"
#include "base/vec.h"
#include "image/sample_images.h"
#include "image/temporary_folder.h"

namespace lumirank::image {
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
      ASSERT_EQ(std::bit_cast<std::uint32_t>(a.pixels[i][c]), std::bit_cast<std::uint32_t>(b.pixels[i][c]))
          << i;
}

std::string message_of_reading(const std::string& filename, std::size_t max_pixels = 1 << 20) {
  try {
    read_image(filename, false, max_pixels);
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().file, filename);
    return error.what();
  }
  return "";
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

TEST_F(ImageIo, LayersBecomeNamedChannels) {
  const Image color = pattern(8, 5, 1), direct = pattern(8, 5, 2), lamp = pattern(8, 5, 3);
  write_image(path("a.exr"), {color, {{"direct", direct}, {"light:lamp", lamp}}});
  expect_same_bits(read_image(path("a.exr")).color, color);

  Imf::InputFile input(path("a.exr").c_str());
  std::size_t channels = 0;
  for (auto c = input.header().channels().begin(); c != input.header().channels().end(); ++c) ++channels;
  EXPECT_EQ(channels, 9u);
  const auto expect_channel = [&](const std::string& name, const Image& image, int component) {
    const Imf::Channel* channel = input.header().channels().findChannel(name.c_str());
    ASSERT_TRUE(channel) << name;
    EXPECT_EQ(channel->type, Imf::FLOAT) << name;
    std::vector<float> data(image.pixels.size());
    Imf::FrameBuffer frame;
    frame.insert(name.c_str(), Imf::Slice::Make(Imf::FLOAT, data.data(), input.header().dataWindow()));
    input.setFrameBuffer(frame);
    input.readPixels(0, image.height - 1);
    for (std::size_t i = 0; i < data.size(); ++i) EXPECT_EQ(data[i], image.pixels[i][component]) << name;
  };
  const char* components[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    expect_channel(components[c], color, c);
    expect_channel(std::string("direct.") + components[c], direct, c);
    expect_channel(std::string("light:lamp.") + components[c], lamp, c);
  }
}

TEST_F(ImageIo, WritingTwiceGivesTheSameBytes) {
  const Image image = pattern(20, 20, 1);
  for (const char* extension : {".exr", ".pfm", ".png"}) {
    write_image(path(std::string("a") + extension), {image, {}});
    write_image(path(std::string("b") + extension), {image, {}});
    EXPECT_EQ(read_bytes(path(std::string("a") + extension)), read_bytes(path(std::string("b") + extension)));
  }
}

// sRGB(x) = 1.055 x^(1/2.4) - 0.055 above 0.0031308 and 12.92 x below, times 255, rounded:
// 0.5 → 187.52 → 188; 0.18 → 117.65 → 118; 0.001 → 3.29 → 3; 0.002 → 6.59 → 7.
TEST(Display, EncodesSrgb) {
  Image image(2, 2);
  image.pixels = {
      {0.5f, 0.18f, 0.001f}, {0.002f, 1, 0}, {-3, 7, kInfinity}, {std::nanf(""), 0.25f, 0.0031308f}};
  // 0.25 → 136.99 → 137; 0.0031308 → 10.31 → 10.
  const std::vector<unsigned char> expected{188, 118, 3, 7, 255, 0, 0, 255, 255, 0, 137, 10};
  EXPECT_EQ(to_display(image, {}), expected);
  // Two stops down, 0.72 shows as 0.18.
  EXPECT_EQ(to_display(Image(1, 1, Rgb(0.72f)), {.exposure = -2})[0], 118);
}

// Gray 1 → 1/(1+1) = 0.5 → 188. Red L·(r,0,0) with r = 1: L = 0.2126, 1/1.2126 = 0.82467 → 233.9 → 234.
TEST(Display, Reinhard) {
  const DisplayOptions options{.exposure = 0, .tonemap = ToneMap::reinhard};
  EXPECT_EQ(to_display(Image(1, 1, Rgb(1)), options)[0], 188);
  EXPECT_EQ(to_display(Image(1, 1, Rgb(1, 0, 0)), options), (std::vector<unsigned char>{234, 0, 0}));
}

TEST(Display, AgxIsMonotoneFromBlackToWhite) {
  const DisplayOptions options{.exposure = 0, .tonemap = ToneMap::agx};
  int previous = -1;
  for (float stops = -12; stops <= 6; stops += 0.5f) {
    const auto gray = to_display(Image(1, 1, Rgb(std::exp2(stops))), options);
    // The matrices' rows sum to one within 1e-7, so that gray stays gray.
    EXPECT_EQ(gray[0], gray[1]);
    EXPECT_EQ(gray[0], gray[2]);
    EXPECT_GE(gray[0], previous) << stops;
    previous = gray[0];
  }
  EXPECT_GE(previous, 250);
  EXPECT_EQ(to_display(Image(1, 1), options)[0], 0);
  // A very bright saturated light turns pale instead of staying pure.
  const auto red = to_display(Image(1, 1, Rgb(100, 0, 0)), options);
  EXPECT_GT(red[1], 100);
}

TEST_F(ImageIo, PngHoldsWhatTheDisplayShows) {
  const Image image = pattern(7, 5, 0.1f);
  const DisplayOptions options{.exposure = -1, .tonemap = ToneMap::agx};
  write_image(path("a.png"), {image, {}}, options);
  const LoadedImage raw = read_image(path("a.png"), true);
  const auto bytes = to_display(image, options);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(std::lround(raw.color.pixels[i][c] * 255), bytes[3 * i + c]);
}

// Code 188: ((188/255 + 0.055)/1.055)^2.4 = 0.502886; code 3: 3/255/12.92 = 9.1058e-4.
TEST_F(ImageIo, EightAndSixteenBitsAreDecodedUnlessRaw) {
  write_sample_png(path("a.png"), {2, 1, 8, 2}, {188, 3, 255, 0, 188, 3});
  const Image decoded = read_image(path("a.png")).color;
  EXPECT_FLOAT_EQ(decoded.at(0, 0).r, 0.50288644f);
  EXPECT_NEAR(decoded.at(0, 0).g, 9.1058e-4f, 1e-8f);
  EXPECT_EQ(decoded.at(0, 0).b, 1.0f);
  EXPECT_EQ(decoded.at(1, 0).r, 0.0f);
  EXPECT_FLOAT_EQ(read_image(path("a.png"), true).color.at(0, 0).r, 188 / 255.0f);

  // 48316 = 188·257 is the same level in 16 bits.
  write_sample_png(path("b.png"), {1, 1, 16, 2}, {188, 188, 3, 3, 255, 255});
  EXPECT_FLOAT_EQ(read_image(path("b.png")).color.at(0, 0).r, 0.50288644f);
  EXPECT_FLOAT_EQ(read_image(path("b.png"), true).color.at(0, 0).g, 771 / 65535.0f);
}

TEST_F(ImageIo, OneToFourChannels) {
  // Code 51 is 1/5 of 255; the rounded 1/255 that it is multiplied by may be one bit off.
  const float fifth = 51 * (1 / 255.0f), two_fifths = 102 * (1 / 255.0f);
  write_sample_png(path("1.png"), {2, 1, 8, 0}, {255, 51});
  write_sample_png(path("2.png"), {2, 1, 8, 4}, {255, 51, 51, 255});
  write_sample_png(path("4.png"), {1, 1, 8, 6}, {255, 51, 102, 51});
  write_sample_exr(path("1.exr"), {2, 1, 0, 0, {"Y"}});
  write_sample_exr(path("4.exr"), {1, 1, 0, 0, {"R", "G", "B", "A"}});

  const LoadedImage one = read_image(path("1.png"), true);
  EXPECT_EQ(one.color.at(1, 0), Rgb(fifth));
  EXPECT_TRUE(one.alpha.empty());
  const LoadedImage two = read_image(path("2.png"), true);
  EXPECT_EQ(two.color.at(0, 0), Rgb(1)) << "not multiplied by its alpha";
  EXPECT_EQ(two.alpha, (std::vector<float>{fifth, 1.0f}));
  const LoadedImage four = read_image(path("4.png"), true);
  EXPECT_EQ(four.color.at(0, 0), Rgb(1, fifth, two_fifths));
  EXPECT_EQ(four.alpha, std::vector<float>{fifth});
  EXPECT_EQ(read_image(path("1.exr")).color.at(1, 0), Rgb(1.125f));
  const LoadedImage exr = read_image(path("4.exr"));
  EXPECT_EQ(exr.color.at(0, 0), Rgb(1, 2, 3));
  EXPECT_EQ(exr.alpha, std::vector<float>{4});
  // Alpha is coverage, never a color: it is not decoded.
  EXPECT_EQ(read_image(path("4.png")).alpha, std::vector<float>{fifth});
}

TEST_F(ImageIo, GrayPfmAndBigEndianPfm) {
  const auto big_endian = [](float v) {
    const std::uint32_t bits = __builtin_bswap32(std::bit_cast<std::uint32_t>(v));
    return std::string(reinterpret_cast<const char*>(&bits), 4);
  };
  // The bottom row comes first in the file.
  write_bytes(path("a.pfm"), "Pf\n1 2\n1.0\n" + big_endian(0.25f) + big_endian(-8));
  const Image image = read_image(path("a.pfm")).color;
  EXPECT_EQ(image.at(0, 0), Rgb(-8));
  EXPECT_EQ(image.at(0, 1), Rgb(0.25f));
}

TEST_F(ImageIo, TiledExrWithMoreRowsThanOneStrip) {
  const int width = 1500, height = 1500;  // a strip is about a million pixels
  write_sample_exr(path("t.exr"), {width, height, 0, 0, {"R", "G", "B"}, 'f', 0, 64});
  const Image image = read_image(path("t.exr")).color;
  ASSERT_EQ(image.pixels.size(), static_cast<std::size_t>(width) * height);
  for (const auto& [x, y] : {std::pair{0, 0}, {1499, 0}, {3, 699}, {1000, 700}, {7, 1398}, {1499, 1499}}) {
    const float value = 1 + static_cast<float>(x) / 8 + 3 * static_cast<float>(y) / 4;
    EXPECT_EQ(image.at(x, y), Rgb(value, value + 1, value + 2)) << x << " " << y;
  }
}

TEST_F(ImageIo, CutFilesAreErrors) {
  const int width = 64, height = 48;
  const std::string pixels = sample_pattern(width * height * 3);
  write_sample_png(path("a.png"), {width, height});
  write_sample_jpeg(path("a.jpg"), {width, height});
  write_bytes(path("a.tga"), sample_tga(width, height, 3, pixels));
  write_bytes(path("a.bmp"), sample_bmp(width, height, pixels));
  write_bytes(path("a.tif"), sample_tiff(width, height, pixels));
  write_image(path("a.exr"), {pattern(width, height, 1), {}});
  write_image(path("a.pfm"), {pattern(width, height, 1), {}});
  for (const char* name : {"a.png", "a.jpg", "a.tga", "a.bmp", "a.tif", "a.exr", "a.pfm"}) {
    const std::string whole = read_bytes(path(name));
    EXPECT_EQ(message_of_reading(path(name)), "") << name;
    for (const double part : {0.0, 0.02, 0.3, 0.6, 0.9}) {
      const std::string cut = path(std::string("cut-") + name);
      write_bytes(cut, whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
      EXPECT_NE(message_of_reading(cut), "") << name << " cut to " << part;
    }
  }
}

TEST_F(ImageIo, WhatIsNotAnImage) {
  EXPECT_NE(message_of_reading(path("none.exr")).find("does not exist"), std::string::npos);
  EXPECT_NE(message_of_reading(path("")), "") << "a folder";
  write_bytes(path("text.png"), "These are only words, and no picture at all.\n");
  write_bytes(path("text.exr"), std::string(1000, 'x'));
  write_bytes(path("empty.hdr"), "");
  for (const char* name : {"text.png", "text.exr", "empty.hdr"})
    EXPECT_NE(message_of_reading(path(name)), "") << name;
}

TEST_F(ImageIo, AbsurdSizesFailBeforeTheMemoryIsTaken) {
  write_bytes(path("a.pfm"), "PF\n2000000000 2000000000\n-1\n");
  write_bytes(path("b.pfm"), "PF\n-4 7\n-1\n");
  write_bytes(path("c.pfm"), "PF\n99999999999999999999 1\n-1\n");
  write_bytes(path("a.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2000000000 +X 2000000000\n");
  write_bytes(path("b.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16000 +X 16000\n");
  for (const char* name : {"a.pfm", "b.pfm", "c.pfm", "a.hdr", "b.hdr"})
    EXPECT_NE(message_of_reading(path(name), std::size_t{1} << 28), "") << name;

  // A true EXR file whose data window is then patched: the attribute ends in "box2i\0", its size, and four
  // ints.
  write_image(path("a.exr"), {pattern(4, 4, 1), {}});
  std::string bytes = read_bytes(path("a.exr"));
  const std::size_t at = bytes.find(std::string("dataWindow\0box2i\0", 17));
  ASSERT_NE(at, std::string::npos);
  for (const std::int32_t size : {15000, 1000000, 2147483646, -5}) {
    const std::int32_t window[4] = {0, 0, size, size};
    bytes.replace(at + 21, 16, reinterpret_cast<const char*>(window), 16);
    write_bytes(path("b.exr"), bytes);
    EXPECT_NE(message_of_reading(path("b.exr"), std::size_t{1} << 28), "") << size;
  }

  // As high as the limit allows, but the file has no room for the table of its chunks.
  const std::int32_t tall[4] = {0, 0, 0, (1 << 28) - 1};
  bytes.replace(at + 21, 16, reinterpret_cast<const char*>(tall), 16);
  write_bytes(path("b.exr"), bytes);
  EXPECT_NE(message_of_reading(path("b.exr"), std::size_t{1} << 28).find("more than the file holds"),
            std::string::npos);

  write_image(path("big.pfm"), {pattern(10, 10, 1), {}});
  EXPECT_NE(message_of_reading(path("big.pfm"), 99).find("10 x 10 pixels, more than the limit of 99"),
            std::string::npos);
  EXPECT_EQ(message_of_reading(path("big.pfm"), 100), "");
}

TEST_F(ImageIo, PathsThatCannotBeWritten) {
  const LayeredImage image{pattern(4, 4, 1), {}};
  for (const char* name : {"a.jpg", "a", "a.exr.bak", ""}) {
    EXPECT_THROW(check_writable(path(name)), InputError) << name;
    EXPECT_THROW(write_image(path(name), image), InputError) << name;
  }
  EXPECT_THROW(check_writable(path("none/a.exr")), InputError);
  EXPECT_THROW(write_image(path("none/a.png"), image), InputError);
  std::filesystem::create_directory(path("folder.exr"));
  EXPECT_THROW(check_writable(path("folder.exr")), InputError);
  // A name that no file system takes: the same as a folder without permission, and true for root as well.
  EXPECT_THROW(check_writable(path(std::string(300, 'x') + ".exr")), InputError);
  if (geteuid() != 0) {
    std::filesystem::create_directory(path("locked"));
    chmod(path("locked").c_str(), 0500);
    EXPECT_THROW(check_writable(path("locked/a.exr")), InputError);
    chmod(path("locked").c_str(), 0700);
  }
  EXPECT_NO_THROW(check_writable(path("b.exr")));
  EXPECT_FALSE(std::filesystem::exists(path("b.exr"))) << "checking leaves nothing behind";
}

TEST_F(ImageIo, ReplacesFilesAndFollowsLinks) {
  write_image(path("a.pfm"), {pattern(4, 4, 1), {}});
  std::filesystem::create_symlink("a.pfm", path("link.pfm"));
  const Image other = pattern(5, 3, 2);
  write_image(path("link.pfm"), {other, {}});
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.pfm")));
  expect_same_bits(read_image(path("a.pfm")).color, other);
  EXPECT_EQ(files().size(), 2u);
}

// Most pictures are shown as they are; of some nothing would be seen.
TEST(Exposure, IsForPicturesThatWouldBeWhiteOrBlack) {
  const auto ramp = [](float from, float to) {  // of 1,000 pixels, a fifth of them black
    std::vector<float> rgb(3000, 0.0f);
    for (int p = 200; p < 1000; ++p)
      for (int c = 0; c < 3; ++c)
        rgb[static_cast<std::size_t>(3 * p + c)] = from + (to - from) * static_cast<float>(p - 200) / 799;
    return rgb;
  };
  EXPECT_EQ(exposure_to_see(ramp(0.5f, 4)), 0) << "bright, and more than a tenth of it can be seen";
  EXPECT_EQ(exposure_to_see(ramp(0, 0.03f)), 0) << "dark";
  EXPECT_EQ(exposure_to_see(ramp(2, 2)), -2);
  EXPECT_EQ(exposure_to_see(ramp(1000, 1024)), -11);
  EXPECT_EQ(exposure_to_see(ramp(0.0078125f, 0.0078125f)), 6);
  EXPECT_EQ(exposure_to_see(std::vector<float>(30, 0.0f)), 0);
  EXPECT_EQ(exposure_to_see({}), 0);
}

TEST_F(ImageIo, BytesInMemoryGiveWhatTheFileGives) {
  for (const char* name : {"a.png", "a.jpg"}) {
    const std::string file = path(name);
    const int channels = std::string(name) == "a.png" ? 4 : 3;
    if (channels == 4) {
      write_sample_png(file, {6, 5, 8, 6});
    } else {
      write_sample_jpeg(file, {6, 5});
    }
    const std::string bytes = read_bytes(file);
    for (const bool raw : {false, true}) {
      const LoadedImage from_file = read_image(file, raw), from_bytes = decode_image(bytes, "x", raw);
      expect_same_bits(from_file.color, from_bytes.color);
      EXPECT_EQ(from_file.alpha, from_bytes.alpha);
      EXPECT_EQ(from_bytes.alpha.empty(), channels == 3);
    }
    EXPECT_THROW(decode_image(bytes, "x", false, 29), InputError) << "30 pixels";
    EXPECT_THROW(decode_image(bytes.substr(0, bytes.size() / 2), "x"), InputError);
  }
  EXPECT_THROW(decode_image("", "x"), InputError);
  // Two pixels of lossless WebP.
  const std::string webp(
      "RIFF\x20\0\0\0WEBPVP8L\x14\0\0\0\x2f\x01\0\0\x10\x0f\x30\x80\xfb\x3f\xff\xa7\xf9\x0f\x2d\x54\x20"
      "\xa2\xff\x01",
      40);
  const LoadedImage pair = decode_image(webp, "x", true);
  EXPECT_EQ(pair.color.at(0, 0), Rgb(1, 0, 0));
  EXPECT_NEAR(pair.color.at(1, 0).g, 128.0f / 255, 0.01f) << "OpenImageIO multiplies by alpha";
  EXPECT_NEAR(pair.alpha.at(1), 0.2f, 1e-6f);
  EXPECT_THROW(decode_image(webp.substr(0, 30), "x"), InputError);
  EXPECT_THROW(decode_image("GIF89a", "x"), InputError);
}

}  // namespace
}  // namespace lumirank::image
