// Slices: every row in one, none too large, alike within.
#include "methods/common/slices/slices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "base/parallel.h"
#include "base/random.h"

namespace lumirank::methods {
namespace {

using matrix::Index;

// Receivers on the six walls of a room, in random order.
struct Room {
  explicit Room(std::size_t rows) : position(rows), normal(rows) {
    for (std::size_t i = 0; i < rows; ++i) {
      Rng rng(1, Stage::test, i);
      Vec3f p{rng.next_float(), rng.next_float(), rng.next_float()};
      const int wall = static_cast<int>(rng.next_below(6)), axis = wall / 2;
      p[axis] = wall % 2 == 0 ? 0.0f : 1.0f;
      position[i] = p;
      normal[i][axis] = wall % 2 == 0 ? 1.0f : -1.0f;
    }
  }
  matrix::RowFeatures features() const { return {{}, position, normal, {}}; }
  std::vector<Vec3f> position, normal;
};

TEST(Slices, HoldEveryRowOnceAndNoMoreThanAskedFor) {
  for (std::size_t rows : {0u, 1u, 7u, 8u, 9u, 1000u, 4097u}) {
    const Room room(rows);
    const Slices slices = make_slices(room.features(), rows, 8);
    EXPECT_EQ(slices.count(), (rows + 7) / 8);
    std::vector<Index> seen;
    for (std::size_t s = 0; s < slices.count(); ++s) {
      const auto slice = slices.slice(s);
      EXPECT_GE(slice.size(), 1u);
      EXPECT_LE(slice.size(), 8u);
      EXPECT_TRUE(std::is_sorted(slice.begin(), slice.end()));
      seen.insert(seen.end(), slice.begin(), slice.end());
    }
    std::sort(seen.begin(), seen.end());
    for (std::size_t i = 0; i < rows; ++i) ASSERT_EQ(seen[i], i);
    EXPECT_EQ(seen.size(), rows);
  }
}

TEST(Slices, AreTheSameForAnyNumberOfThreads) {
  const Room room(50000);
  Slices first;
  for (int threads : {1, 2, 4})
    with_threads(threads, [&] {
      const Slices slices = make_slices(room.features(), 50000, 300);
      if (threads == 1) first = slices;
      EXPECT_EQ(slices.rows, first.rows);
      EXPECT_EQ(slices.first, first.first);
    });
}

// A wall of the unit room has 1/6 of the rows. A slice of one wall covers 6/slices of its area, so a square
// one has a diagonal of √2·√(6/slices); cut at 2:1 it has √2.5 instead of √2, and where a cell holds an edge
// of the room it spans two walls. Twice that bounds all but those few. Where nothing is known of normals the
// 12 edges of the room cross 12/√(6/600) = 120 of 600 slices; three quarters of that would show that much is.
TEST(Slices, AreCompactAndKeepWallsApart) {
  constexpr std::size_t kRows = 60000, kMax = 100;
  const Room room(kRows);
  const Slices slices = make_slices(room.features(), kRows, kMax);
  std::size_t compact = 0, of_one_wall = 0;
  const float side = std::sqrt(6.0f / static_cast<float>(slices.count()));
  for (std::size_t s = 0; s < slices.count(); ++s) {
    Bounds3f box;
    std::set<std::array<float, 3>> normals;
    for (const Index i : slices.slice(s)) {
      box.extend(room.position[i]);
      normals.insert({room.normal[i].x, room.normal[i].y, room.normal[i].z});
    }
    compact += length(box.diagonal()) <= 2 * std::sqrt(2.5f) * side;
    of_one_wall += normals.size() == 1;
  }
  EXPECT_GE(compact, slices.count() * 95 / 100);
  EXPECT_GE(of_one_wall, slices.count() * 85 / 100);
}

// The two sides of a sheet: at the same places, so only normals tell them apart.
TEST(Slices, KeepTheSidesOfASheetApart) {
  constexpr std::size_t kRows = 4096;
  std::vector<Vec3f> position(kRows), normal(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    Rng rng(1, Stage::test, i / 2);
    position[i] = {rng.next_float(), rng.next_float(), 0};
    normal[i] = {0, 0, i % 2 == 0 ? 1.0f : -1.0f};
  }
  const Slices slices = make_slices({{}, position, normal, {}}, kRows, 32);
  for (std::size_t s = 0; s < slices.count(); ++s)
    for (const Index i : slices.slice(s)) EXPECT_EQ(i % 2, slices.slice(s)[0] % 2);
}

// Rows on a square, 64 × 64 pixels of four each. What one slice has, another has beside it within the overlap
// and nowhere else, and rows of a pixel go together.
TEST(Slices, OverlapNearTheirEdgesAlone) {
  constexpr std::size_t kSide = 64, kRows = kSide * kSide * 4;
  std::vector<Vec2f> pixel(kRows);
  std::vector<Vec3f> position(kRows), normal(kRows, Vec3f{0, 0, 1});
  for (std::size_t i = 0; i < kRows; ++i) {
    const auto x = static_cast<float>(i / 4 % kSide), y = static_cast<float>(i / 4 / kSide);
    pixel[i] = {x + 0.2f * static_cast<float>(i % 4), y + 0.5f};
    position[i] = {x, y, 0};
  }
  const matrix::RowFeatures features{pixel, position, normal, {}};
  // Two slices: cut in the middle, at 31.5, and a slice's side is a cell's over √2.
  constexpr float kShare = 0.25f, kReach = kShare * (kSide - 1) / std::numbers::sqrt2_v<float>;
  const auto slice_of = [&](std::uint64_t seed) {
    std::vector<std::size_t> of(kRows);
    const Slices slices = make_slices(features, kRows, kRows / 2, {kShare, seed});
    EXPECT_EQ(slices.count(), 2u);
    for (std::size_t s = 0; s < slices.count(); ++s)
      for (const Index i : slices.slice(s)) of[i] = s;
    return of;
  };
  const auto of = slice_of(1), of_other_seed = slice_of(2);
  std::size_t crossed = 0, moved = 0;
  for (std::size_t i = 0; i < kRows; ++i) {
    EXPECT_EQ(of[i], of[i / 4 * 4]);
    const float from_cut = position[i].x - 31.5f;
    if ((from_cut > 0) != (of[i] == 1)) {
      ++crossed;
      EXPECT_LT(std::abs(from_cut), kReach + 2);
    }
    moved += of[i] != of_other_seed[i];
  }
  // At a distance d within the reach a half of 1 - d/reach is on the other side: a quarter of 2·11/64 in all.
  EXPECT_NEAR(static_cast<double>(crossed) / kRows, 0.25 * 2 * kReach / kSide, 0.01);
  EXPECT_GT(moved, crossed / 2);
}

TEST(Slices, DealTheirPixelsEvenly) {
  constexpr std::size_t kPixels = 1000, kParts = 8;
  std::vector<Vec2f> pixel;
  std::vector<Index> slice;
  for (std::size_t p = 0; p < kPixels; ++p)
    for (std::size_t k = 0; k <= p % 3; ++k) {
      slice.push_back(static_cast<Index>(pixel.size()));
      pixel.push_back({static_cast<float>(p) + 0.5f, 3});
    }
  PixelDeal deal;
  deal.deal({pixel, {}, {}, {}}, slice, kParts, 7);
  std::vector<std::size_t> part_of(pixel.size(), kParts);
  for (std::size_t d = 0; d < kParts; ++d)
    for (const Index i : deal.part(d)) {
      ASSERT_EQ(part_of[i], kParts);
      part_of[i] = d;
    }
  std::map<std::size_t, std::size_t> of_pixel;
  for (std::size_t i = 0; i < pixel.size(); ++i) {
    ASSERT_LT(part_of[i], kParts);
    const auto [known, fresh] = of_pixel.try_emplace(static_cast<std::size_t>(pixel[i].x), part_of[i]);
    EXPECT_EQ(known->second, part_of[i]);
  }
  std::set<std::size_t> first;  // parts of stretches' first pixels
  for (std::size_t p = 0; p + kParts <= kPixels; p += kParts) {
    std::set<std::size_t> parts;
    for (std::size_t k = 0; k < kParts; ++k) parts.insert(of_pixel[p + k]);
    EXPECT_EQ(parts.size(), kParts);
    first.insert(of_pixel[p]);
  }
  EXPECT_EQ(first.size(), kParts);
}

TEST(Slices, WithoutFeaturesAreStretchesOfTheIndex) {
  const Slices slices = make_slices({}, 1000, 64);
  for (std::size_t i = 0; i < 1000; ++i) EXPECT_EQ(slices.rows[i], i);
}

}  // namespace
}  // namespace lumirank::methods
