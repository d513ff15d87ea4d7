// Grids of numbers in files: what is read, what is refused, and what is written comes back.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "mesh_builders.h"
#include "scenedesc/volumes/vol_file.h"
#include "support/refused.h"
#include "support/scene_file.h"

namespace lumirank::scenedesc {
namespace {

// What comes before the values.
std::string vol_header(std::int32_t encoding, std::array<std::int32_t, 3> size, std::int32_t channels) {
  std::string out = "VOL\3";
  put(out, encoding);
  for (const std::int32_t n : size) put(out, n);
  put(out, channels);
  for (const float corner : {-1.0f, 0.0f, 2.0f, 1.0f, 4.0f, 2.5f}) put(out, corner);
  return out;
}

TEST(VolFiles, AGridOfFloats) {
  std::string bytes = vol_header(1, {3, 2, 1}, 3);
  for (int k = 0; k < 18; ++k) put(bytes, 0.25f * static_cast<float>(k));
  const GridData grid = parse_vol(bytes, "a.vol");
  EXPECT_EQ(grid.size, (std::array<int, 3>{3, 2, 1}));
  EXPECT_EQ(grid.channels, 3);
  EXPECT_EQ(grid.lo, (Vec3f{-1, 0, 2}));
  EXPECT_EQ(grid.hi, (Vec3f{1, 4, 2.5f}));
  ASSERT_EQ(grid.values.size(), 18u);
  EXPECT_EQ(grid.values[1], 0.25f);
  EXPECT_EQ(grid.values[17], 4.25f);
}

// All 65,536 of them, against the definition: ±(1 + f/1024)·2^(e - 15), and ±f/1024·2^-14 for e = 0.
TEST(VolFiles, HalfFloats) {
  for (int bits = 0; bits < 65536; ++bits) {
    std::string bytes = vol_header(2, {1, 1, 1}, 1);
    put(bytes, static_cast<std::uint16_t>(bits));
    const int exponent = (bits / 1024) % 32, fraction = bits % 1024;
    if (exponent == 31) {
      EXPECT_THROW(parse_vol(bytes, "a.vol"), InputError) << bits;
      continue;
    }
    const double size = exponent == 0 ? fraction / 1024.0 * std::pow(2, -14)
                                      : (1 + fraction / 1024.0) * std::pow(2, exponent - 15);
    ASSERT_EQ(double{parse_vol(bytes, "a.vol").values[0]}, bits < 32768 ? size : -size) << bits;
  }
}

TEST(VolFiles, BytesAreFractionsOf255) {
  std::string bytes = vol_header(3, {256, 1, 1}, 1);
  for (int k = 0; k < 256; ++k) bytes += static_cast<char>(k);
  const GridData grid = parse_vol(bytes, "a.vol");
  for (int k = 0; k < 256; ++k)
    EXPECT_EQ(grid.values[static_cast<std::size_t>(k)], static_cast<float>(k) / 255.0f);
}

TEST(VolFiles, WhatIsNoGridIsRefusedByName) {
  const auto expect = [](const std::string& bytes, const char* says) {
    const std::string error = test::refused([&] { parse_vol(bytes, "smoke.vol"); });
    EXPECT_NE(error.find(says), std::string::npos) << says << " is not in: " << error;
    EXPECT_NE(error.find("smoke.vol"), std::string::npos) << error;
  };
  std::string good = vol_header(1, {2, 1, 1}, 1);
  put(good, 1.0f), put(good, 2.0f);
  EXPECT_EQ(parse_vol(good, "smoke.vol").values.size(), 2u);
  // With other bytes at a place of the header.
  const auto changed = [&](std::size_t at, auto value) {
    std::string bytes = good, raw;
    put(raw, value);
    return bytes.replace(at, raw.size(), raw);
  };

  expect("", "begin with VOL");
  expect("VOL", "begin with VOL");
  expect(good.substr(0, 47), "begin with VOL");
  expect(changed(0, 'v'), "begin with VOL");
  expect(changed(3, '\2'), "version 2");
  expect(changed(3, '\xff'), "version 255");
  expect(changed(4, std::int32_t{0}), "encoding 0");
  expect(changed(4, std::int32_t{4}), "directions");
  expect(changed(4, std::int32_t{5}), "encoding 5");
  expect(changed(8, std::int32_t{0}), "0 places along x");
  expect(changed(12, std::int32_t{-1}), "-1 places along y");
  const std::int32_t huge = std::numeric_limits<std::int32_t>::max();
  expect(changed(16, huge), std::to_string(huge).c_str());
  // Each axis alone would do.
  std::string large = vol_header(1, {65536, 65536, 2}, 1);
  expect(large, "65536 places along y");
  expect(vol_header(1, {1024, 1024, 1024}, 3), "numbers");
  for (const std::int32_t channels : {-1, 0, 2, 4, 6}) expect(changed(20, channels), "channels");
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  for (std::size_t corner = 24; corner < 48; corner += 4)
    for (const float value : {nan, infinite, -infinite}) expect(changed(corner, value), "box");
  expect(changed(24, 1.0f), "box");   // no width
  expect(changed(40, -3.0f), "box");  // upside down
  expect(good.substr(0, 48), "8 bytes of values and has 0");
  expect(good.substr(0, 55), "cut off");
  expect(good + '\0', "8 bytes of values and has 9");
  expect(changed(4, std::int32_t{3}), "2 bytes of values and has 8");
  expect(changed(48, nan), "number 0");
  expect(changed(52, infinite), "number 1");
}

TEST(VolFiles, WhatIsWrittenComesBack) {
  Rng rng(1, Stage::test);
  for (const int channels : {1, 3}) {
    GridData grid;
    grid.size = {3, 5, 2}, grid.channels = channels;
    grid.lo = {-0.1f, 2, 1e-3f}, grid.hi = {7, 1e6f, 1.1f};
    for (int k = 0; k < 30 * channels; ++k)
      grid.values.push_back(std::ldexp(rng.next_float() - 0.25f, k - 20));
    const GridData back = parse_vol(vol_bytes(grid), "a.vol");
    EXPECT_EQ(back.size, grid.size);
    EXPECT_EQ(back.channels, grid.channels);
    EXPECT_EQ(back.lo, grid.lo);
    EXPECT_EQ(back.hi, grid.hi);
    EXPECT_EQ(back.values, grid.values);
  }
}

TEST(VolFiles, AreReadFromDisk) {
  const test::TemporaryFolder folder;
  std::string floats = vol_header(1, {1, 1, 1}, 1), bytes = vol_header(3, {1, 1, 1}, 1);
  put(floats, 0.75f), bytes += '\xff';
  std::ofstream(folder / "floats.vol", std::ios::binary) << floats;
  std::ofstream(folder / "bytes.vol", std::ios::binary) << bytes;
  bool of_floats = false;
  EXPECT_EQ(read_vol(folder / "floats.vol", &of_floats).values[0], 0.75f);
  EXPECT_TRUE(of_floats);
  EXPECT_EQ(read_vol(folder / "bytes.vol", &of_floats).values[0], 1.0f);
  EXPECT_FALSE(of_floats);
  const std::string error = test::refused([&] { read_vol(folder / "none.vol"); });
  EXPECT_NE(error.find("none.vol"), std::string::npos) << error;
}

// Changed in some bytes, a file is read or refused.
TEST(VolFiles, DamageIsNoHarm) {
  std::string good = vol_header(1, {2, 2, 2}, 1);
  for (int k = 0; k < 8; ++k) put(good, static_cast<float>(k));
  Rng rng(2, Stage::test);
  int refused = 0;
  for (int k = 0; k < 5000; ++k) {
    std::string bytes = good;
    for (int change = 0; change < 3; ++change)
      bytes[static_cast<std::size_t>(rng.next_float() * static_cast<float>(bytes.size()))] =
          static_cast<char>(rng.next_below(256));
    if (rng.next_float() < 0.2f) bytes.resize(static_cast<std::size_t>(rng.next_float() * 90));
    try {
      const GridData grid = parse_vol(bytes, "a.vol");
      EXPECT_EQ(grid.values.size(),
                static_cast<std::size_t>(grid.size[0] * grid.size[1] * grid.size[2] * grid.channels));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace lumirank::scenedesc
