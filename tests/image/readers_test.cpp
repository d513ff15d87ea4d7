// The readers of the formats, one by one, against OpenImageIO and against files that are not what they say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <thread>
#include <utility>

#include "base/error.h"
#include "image/exr_channels.h"
#include "image/exr_file.h"
#include "image/image_builder.h"
#include "image/image_io.h"
#include "image/other_formats.h"
#include "image/radiance_file.h"
#include "image/sample_images.h"
#include "image/temporary_folder.h"

namespace lumirank::image {
namespace {

constexpr std::size_t kFewPixels = 1 << 16;

bool same_picture(const LoadedImage& a, const LoadedImage& b) {
  return a.color.width == b.color.width && a.color.height == b.color.height &&
         a.color.pixels.size() == b.color.pixels.size() && a.alpha.size() == b.alpha.size() &&
         std::memcmp(a.color.pixels.data(), b.color.pixels.data(), a.color.pixels.size() * sizeof(Rgb)) ==
             0 &&
         (a.alpha.empty() ||
          std::memcmp(a.alpha.data(), b.alpha.data(), a.alpha.size() * sizeof(float)) == 0);
}

LoadedImage by_openimageio(const std::string& file, bool raw) {
  ImageBuilder builder(file, raw, kFewPixels);
  read_other_format(file, builder);
  return builder.take();
}

// "" if the file can be read; otherwise the message, which names the file.
std::string refusal(const std::string& file) {
  try {
    const LoadedImage image = read_image(file, false, kFewPixels);
    EXPECT_LE(image.color.pixels.size(), kFewPixels) << file;
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().file, file);
    return error.what();
  }
  return "";
}

std::string radiance(const std::string& size, const std::string& pixels,
                     const std::string& format = "FORMAT=32-bit_rle_rgbe\n") {
  return "#?RADIANCE\n# a comment\n" + format + "EXPOSURE=2\n\n" + size + "\n" + pixels;
}

Image read_radiance_bytes(const std::string& bytes) {
  ImageBuilder builder("a.hdr", false, kFewPixels);
  read_radiance(bytes, builder);
  return builder.take().color;
}

// Pixel k is (k, 128, 0) / 256 times 2.
std::string numbered_pixels(int count) {
  std::string pixels;
  for (int k = 0; k < count; ++k)
    pixels += {static_cast<char>(k), static_cast<char>(128), 0, static_cast<char>(129)};
  return pixels;
}

class Readers : public TemporaryFolder {};

// OpenImageIO read everything once; whatever is read without it now has the same bits.
TEST_F(Readers, AgreeWithOpenImageIoToTheBit) {
  std::vector<std::string> files = write_all_samples(path(""), false);
  // Its table of powers of two is rounded for three exponents (40, 223 and 226), which these leave out.
  const std::string mantissas = sample_pattern(3000);
  std::string flat, rows;
  for (std::size_t k = 0; k < 7 * 5; ++k) flat += mantissas.substr(3 * k, 3) + static_cast<char>(110 + k);
  for (std::size_t y = 0; y < 300; ++y)  // a literal stretch of nine, and a run of two, for each component
    for (std::size_t c = 0; c < 4; ++c)
      rows += (c == 0 ? std::string("\2\2\0\13", 4) : "") + "\11" +
              (c == 3 ? "dgjmpsvy|" : mantissas.substr(9 * y, 9)) + "\202" + static_cast<char>(80 + y % 120);
  write_bytes(path("flat.hdr"), radiance("-Y 7 +X 5", flat));
  write_bytes(path("runs.hdr"), radiance("-Y 300 +X 11", rows));
  files.push_back(path("flat.hdr")), files.push_back(path("runs.hdr"));
  for (const std::string& file : files)
    for (const bool raw : {false, true})
      EXPECT_TRUE(same_picture(read_image(file, raw, kFewPixels), by_openimageio(file, raw)))
          << file << (raw ? ", raw" : "");
  EXPECT_GT(files.size(), 90u);
}

TEST_F(Readers, OtherFormatsAreReadByOpenImageIo) {
  const std::vector<std::string> files = write_all_samples(path(""), true);
  const std::string bytes = sample_pattern(9 * 7 * 4);
  const auto byte = [&](std::size_t at) {
    return static_cast<float>(static_cast<unsigned char>(bytes[at])) / 255;
  };
  for (const std::string& file : files) {
    const LoadedImage image = read_image(file, true);
    ASSERT_EQ(image.color.width, 9) << file;
    ASSERT_EQ(image.color.height, 7) << file;
    EXPECT_EQ(image.alpha.empty(), !file.ends_with("b.tga")) << file;
    // The first pixel of the file: TIFF begins at the top with red, the others at the bottom with blue.
    const bool tiff = file.ends_with(".tif");
    const Rgb first = image.color.at(0, tiff ? 0 : 6);
    for (int c = 0; c < 3; ++c)
      EXPECT_FLOAT_EQ(first[c], byte(static_cast<std::size_t>(tiff ? c : 2 - c))) << file << " " << c;
  }
}

TEST_F(Readers, TellFormatsByTheirBytesAndNotTheirNames) {
  write_sample_png(path("a.png"), {});
  const Image image = read_image(path("a.png")).color;
  for (const char* name : {"b.jpg", "b.exr", "b.hdr", "b", "b.tga"}) {
    std::filesystem::copy_file(path("a.png"), path(name));
    EXPECT_EQ(read_image(path(name)).color.pixels, image.pixels) << name;
  }
}

TEST_F(Readers, TheSameFromAnyNumberOfThreads) {
  const std::vector<std::string> files = write_all_samples(path(""), false);
  std::vector<LoadedImage> alone(files.size()), together(4 * files.size());
  for (std::size_t i = 0; i < files.size(); ++i) alone[i] = read_image(files[i]);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t i = t; i < together.size(); i += 8) together[i] = read_image(files[i % files.size()]);
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < together.size(); ++i)
    EXPECT_TRUE(same_picture(together[i], alone[i % files.size()])) << files[i % files.size()];
}

// Any length short of the whole is refused, and any byte may be anything without harm.
TEST_F(Readers, BrokenFilesAreRefusedOrRead) {
  write_sample_png(path("a.png"), {5, 4, 8, 6});
  write_sample_png(path("b.png"), {5, 4, 2, 3, true, true});
  write_sample_jpeg(path("a.jpg"), {9, 8});
  write_sample_jpeg(path("b.jpg"), {9, 8, JpegColors::luma_chroma_ink, true});
  write_sample_exr(path("a.exr"), {5, 4});
  write_sample_exr(path("b.exr"), {9, 8, -3, 2, {"Y", "A"}, 'h', 4, 4});
  write_bytes(path("a.hdr"), radiance("-Y 2 +X 8", std::string("\2\2\0\10", 4) + "\210a\210b\210c\210\201" +
                                                       numbered_pixels(8)));
  write_image(path("a.pfm"), {Image(3, 2, Rgb(1)), {}});
  for (const char* name : {"a.png", "b.png", "a.jpg", "b.jpg", "a.exr", "b.exr", "a.hdr", "a.pfm"}) {
    const std::string whole = read_bytes(path(name)), broken = path(std::string("broken-") + name);
    EXPECT_EQ(refusal(path(name)), "") << name;
    // Below four bytes the format is not known, and OpenImageIO is asked.
    const std::size_t step = whole.size() / 100 + 1;
    // Some file systems wait for the disk when a file is cut and written anew.
    const auto write_broken = [&](const std::string& bytes) {
      std::filesystem::remove(broken);
      write_bytes(broken, bytes);
    };
    for (std::size_t size = 4; size < whole.size(); size += step) {
      write_broken(whole.substr(0, size));
      EXPECT_NE(refusal(broken), "") << name << " cut to " << size;
    }
    for (std::size_t at = 4; at < whole.size(); at += step) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(~static_cast<unsigned char>(bytes[at]));
      write_broken(bytes);
      refusal(broken);
    }
  }
  write_bytes(path("empty.png"), "");
  EXPECT_NE(refusal(path("empty.png")).find("empty"), std::string::npos);
}

TEST_F(Readers, HeadersThatPromiseMoreThanTheFileHolds) {
  write_sample_png(path("a.png"), {300, 300, 1, 0});
  EXPECT_NE(refusal(path("a.png")).find("300 x 300 pixels, more than the limit"), std::string::npos);
  // The header of a larger picture, with its own checksum, before the rest of a smaller one.
  write_sample_png(path("b.png"), {250, 250, 16, 6, true});
  write_sample_png(path("c.png"), {3, 3, 16, 6, true});
  write_bytes(path("d.png"), read_bytes(path("b.png")).substr(0, 33) + read_bytes(path("c.png")).substr(33));
  EXPECT_NE(refusal(path("d.png")).find("more than the file holds"), std::string::npos);
  const auto of_radiance = [&](const std::string& size) {
    write_bytes(path("a.hdr"), radiance(size, "1234"));
    return refusal(path("a.hdr"));
  };
  EXPECT_NE(of_radiance("-Y 2000000000 +X 2000000000").find("more than the limit"), std::string::npos);
  EXPECT_NE(of_radiance("-Y 60000 +X 1").find("more than the file holds"), std::string::npos);
  EXPECT_NE(of_radiance("-Y 99999999999 +X 1").find("size"), std::string::npos);
  EXPECT_NE(of_radiance("-Y 0 +X 1"), "");
  EXPECT_NE(of_radiance("-Y -1 +X 1"), "");
}

TEST_F(Readers, ManyScansAreRefused) {
  JpegKind kind;
  kind.every_coefficient_alone = true;
  write_sample_jpeg(path("a.jpg"), kind);
  EXPECT_NE(refusal(path("a.jpg")).find("more than 500 scans"), std::string::npos);
}

TEST_F(Readers, ExrChannelsWithFewerPixels) {
  ExrKind kind;
  kind.width = 8, kind.height = 6, kind.sampling = 2;
  write_sample_exr(path("a.exr"), kind);
  EXPECT_NE(refusal(path("a.exr")).find("channel B has fewer pixels"), std::string::npos);
  kind.channels.push_back("unused");
  write_sample_exr(path("b.exr"), kind);
  EXPECT_EQ(refusal(path("b.exr")), "");
}

// A file that takes only so many bytes.
class FullDisk : public std::stringbuf {
 public:
  explicit FullDisk(std::streamsize room) : room_(room) {}

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    const std::streamsize taken = std::min(count, room_);
    room_ -= taken;
    return std::stringbuf::xsputn(bytes, taken);
  }

 private:
  std::streamsize room_;
};

// OpenEXR writes its table of chunks when it closes the file, and keeps quiet about what goes wrong there.
TEST(ExrWriter, AFullDiskIsAnErrorAtEveryByte) {
  LayeredImage image{Image(6, 40, Rgb(0.25f)), {{"direct", Image(6, 40, Rgb(2))}}};
  const auto written = [&](std::streamsize room) {
    FullDisk disk(room);
    std::ostream out(&disk);
    write_exr(out, image, Precision::single);
    return disk.str();
  };
  const std::string whole = written(1 << 20);
  EXPECT_EQ(whole.substr(0, 4), "\x76\x2f\x31\x01");
  // The table is written twice: room for it first, and what belongs there in the end.
  std::streamsize room = 0;
  for (bool full = true; full; ++room) try {
      EXPECT_EQ(written(room), whole);
      full = false;
    } catch (const std::exception& error) {
      EXPECT_NE(std::string(error.what()).find("disk full"), std::string::npos)
          << room << ": " << error.what();
    }
  EXPECT_GT(room, static_cast<std::streamsize>(whole.size()));
}

TEST(ExrChannelNames, WhichBecomeColor) {
  const auto color_of = [](const std::vector<std::string>& names) {
    const ExrChannels chosen = choose_exr_channels(names);
    return chosen.color[0] + " " + chosen.color[1] + " " + chosen.color[2] + "/" + chosen.alpha;
  };
  EXPECT_EQ(color_of({"A", "B", "G", "R", "direct.B", "direct.G", "direct.R"}), "R G B/A");
  EXPECT_EQ(color_of({"direct.B", "direct.G", "direct.R"}), "direct.R direct.G direct.B/");
  EXPECT_EQ(color_of({"A", "Y"}), "Y Y Y/A");
  EXPECT_EQ(color_of({"Alpha"}), "Alpha Alpha Alpha/Alpha");
  EXPECT_EQ(color_of({"X", "Y", "Z"}), "X Y Z/");
  EXPECT_EQ(color_of({"Y", "Z"}), "Y Y Y/");
  EXPECT_EQ(color_of({"b.B", "b.G", "b.R", "a.r", "a.g", "a.b", "a.a"}), "a.r a.g a.b/a.a");
}

// (k, 128, 0) with exponent 129 is (k / 128, 1, 0).
TEST(Radiance, FlatPixelsInAnyOrder) {
  // Three wide and two high; the pixels of the top row, then of the lower one, by their numbers in the file.
  const std::pair<const char*, std::array<int, 6>> orders[] = {
      {"-Y 2 +X 3", {0, 1, 2, 3, 4, 5}}, {"-Y 2 -X 3", {2, 1, 0, 5, 4, 3}}, {"+Y 2 +X 3", {3, 4, 5, 0, 1, 2}},
      {"+Y 2 -X 3", {5, 4, 3, 2, 1, 0}}, {"+X 3 -Y 2", {0, 2, 4, 1, 3, 5}}, {"+X 3 +Y 2", {1, 3, 5, 0, 2, 4}},
      {"-X 3 -Y 2", {4, 2, 0, 5, 3, 1}}, {"-X 3 +Y 2", {5, 3, 1, 4, 2, 0}}};
  for (const auto& [size, order] : orders) {
    const Image image = read_radiance_bytes(radiance(size, numbered_pixels(6)));
    ASSERT_EQ(image.width, 3) << size;
    ASSERT_EQ(image.height, 2) << size;
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_EQ(image.pixels[k], Rgb(static_cast<float>(order[k]) / 128, 1, 0)) << size << " " << k;
  }
}

TEST(Radiance, RunsOfBothKinds) {
  // Red: eight times 64. Green: three times 128, five different ones. Blue: eight zeros. Exponent: 129.
  const std::string components("\2\2\0\10\210\100\203\200\5\1\2\3\4\5\210\0\210\201", 18);
  const Image image = read_radiance_bytes(radiance("-Y 1 +X 8", components));
  EXPECT_EQ(image.at(2, 0), Rgb(0.5f, 1, 0));
  EXPECT_EQ(image.at(7, 0), Rgb(0.5f, 5 / 128.0f, 0));
  // One pixel and 1 + 2 · 256 of the same, in the digits of 256; then another.
  const std::string runs("\100\200\0\201\1\1\1\1\1\1\1\2\200\0\0\201", 16);
  const Image old = read_radiance_bytes(radiance("-Y 1 +X 515", runs));
  for (const int x : {0, 1, 2, 513}) EXPECT_EQ(old.at(x, 0), Rgb(0.5f, 1, 0)) << x;
  EXPECT_EQ(old.at(514, 0), Rgb(1, 0, 0));
}

TEST(Radiance, WhatIsNotRight) {
  const auto trouble = [](const std::string& bytes) -> std::string {
    try {
      read_radiance_bytes(bytes);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(trouble(radiance("-Y 1 +X 1", numbered_pixels(1))), "");
  EXPECT_NE(trouble(radiance("-Y 1 +X 1", numbered_pixels(1), "FORMAT=32-bit_rle_xyze\n")).find("xyze"),
            std::string::npos);
  EXPECT_NE(trouble(radiance("-Y 1 +X 1", numbered_pixels(1), "")).find("format"), std::string::npos);
  EXPECT_NE(trouble(radiance("-Y 1 -Y 1", numbered_pixels(1))).find("size"), std::string::npos);
  EXPECT_NE(trouble(radiance("-Y 1 +X 2", numbered_pixels(1))).find("truncated"), std::string::npos);
  const std::string damaged[] = {std::string("\2\2\0\11", 4),               // nine wide
                                 std::string("\2\2\0\10\211\100", 6),       // a run of nine
                                 std::string("\2\2\0\10\0\100", 6),         // of none
                                 std::string("\1\1\1\1", 4),                // a repetition of nothing
                                 std::string("\7\200\0\201\1\1\1\10", 8)};  // one too many
  for (const std::string& bytes : damaged) EXPECT_NE(trouble(radiance("-Y 1 +X 8", bytes)), "");
}

}  // namespace
}  // namespace lumirank::image
