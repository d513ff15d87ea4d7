// Slices: every row in one, none too large, alike within.
#include "methods/common/slices/slices.h"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(Slices, WithoutFeaturesAreStretchesOfTheIndex) {
  const Slices slices = make_slices({}, 1000, 64);
  for (std::size_t i = 0; i < 1000; ++i) EXPECT_EQ(slices.rows[i], i);
}

}  // namespace
}  // namespace lumirank::methods
