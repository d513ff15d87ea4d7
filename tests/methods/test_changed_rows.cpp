// The search for rows whose light has changed.
#include "methods/tensor_clustering/changed_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace lumirank::methods {
namespace {

using matrix::Index;

struct ChangedPicture {
  int width = 64, height = 48, per_pixel = 2;
  std::vector<Vec2f> pixel() const {
    std::vector<Vec2f> p;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int s = 0; s < per_pixel; ++s)
          p.push_back(
              {static_cast<float>(x) + 0.25f + 0.5f * static_cast<float>(s), static_cast<float>(y) + 0.5f});
    return p;
  }
};

// All rows for which `changed` holds, and what was asked for them. Each row is asked once.
template <typename Changed>
std::set<Index> search(std::span<const Vec2f> pixel, std::size_t rows, const Changed& changed) {
  std::set<Index> asked;
  const auto order = ask_for_changes(pixel, rows, [&](std::span<const Index> some) {
    std::vector<bool> said;
    for (const Index i : some) {
      EXPECT_TRUE(asked.insert(i).second) << i;
      said.push_back(changed(i));
    }
    return said;
  });
  EXPECT_EQ(std::set<Index>(order.begin(), order.end()), asked);
  return asked;
}

TEST(ChangedRows, OneInEverySquareIsAskedWhereNothingHasChanged) {
  const ChangedPicture picture;
  const auto pixel = picture.pixel();
  const auto asked = search(pixel, pixel.size(), [](Index) { return false; });
  EXPECT_EQ(asked.size(), 8u * 6);
  std::set<std::pair<int, int>> squares;
  for (const Index i : asked)
    squares.insert({static_cast<int>(pixel[i].x) / 8, static_cast<int>(pixel[i].y) / 8});
  EXPECT_EQ(squares.size(), asked.size());
}

// A shadow of 13 pixels across: every row in it is found, and few outside of it are asked.
TEST(ChangedRows, AllOfAShadowIsFound) {
  const ChangedPicture picture;
  const auto pixel = picture.pixel();
  for (const Vec2f middle : {Vec2f{20, 17}, Vec2f{31.9f, 24.2f}, Vec2f{60, 45}}) {
    const auto dark = [&](Index i) {
      return std::hypot(pixel[i].x - middle.x, pixel[i].y - middle.y) < 6.5f;
    };
    const auto asked = search(pixel, pixel.size(), dark);
    std::size_t in_shadow = 0, missed = 0;
    for (Index i = 0; i < pixel.size(); ++i)
      if (dark(i)) ++in_shadow, missed += !asked.contains(i);
    EXPECT_EQ(missed, 0u) << middle.x;
    EXPECT_LT(asked.size(), 3 * in_shadow + 200);
  }
}

TEST(ChangedRows, RowsWithoutPixelsLieOnALine) {
  const auto asked = search({}, 1000, [](Index i) { return i >= 400 && i < 450; });
  for (Index i = 400; i < 450; ++i) EXPECT_TRUE(asked.contains(i)) << i;
  EXPECT_LT(asked.size(), 300u);
  EXPECT_TRUE(ask_for_changes({}, 0, {}).empty());
}

// Films that are cut out of a larger one: pixels need not begin at 0, and may be just outside of it.
TEST(ChangedRows, PixelsMayBeAnywhere) {
  const std::vector<Vec2f> pixel{{-0.4f, 100.5f}, {0.6f, 100.2f}, {7.9f, 103}, {8.1f, 103}};
  EXPECT_EQ(search(pixel, pixel.size(), [](Index) { return true; }).size(), 4u);
}

}  // namespace
}  // namespace lumirank::methods
