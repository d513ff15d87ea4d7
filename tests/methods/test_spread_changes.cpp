#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "methods/tensor_clustering/spread_changes.h"

namespace lumirank::methods {
namespace {

constexpr std::size_t kFloorSide = 48;  // pixels

// A surface seen from above, a row to a pixel; every eighth row of every eighth line is asked.
struct Floor {
  std::vector<Vec2f> pixel;
  std::vector<Vec3f> position, normal;
  std::vector<Rgb> albedo;
  FoundChanges found;
  std::vector<bool> known = std::vector<bool>(kFloorSide * kFloorSide, false);

  template <typename Change>
  explicit Floor(const Change& change) {
    for (std::size_t y = 0; y < kFloorSide; ++y)
      for (std::size_t x = 0; x < kFloorSide; ++x) {
        const Vec2f at{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
        const std::size_t row = pixel.size();
        pixel.push_back(at), position.push_back({at.x, at.y, 0}), normal.push_back({0, 0, 1});
        albedo.push_back(Rgb(0.5f));
        if (x % 8 != 4 || y % 8 != 4) continue;
        found.rows.push_back(static_cast<matrix::Index>(row)), found.change.push_back(change(at));
        known[row] = true;
      }
  }
  std::vector<Rgb> spread() const {
    matrix::RowFeatures features;
    features.pixel = pixel, features.position = position, features.normal = normal;
    features.albedo = albedo;
    return spread_changes(features, found, known);
  }
};

std::size_t row_at(std::size_t x, std::size_t y) { return y * kFloorSide + x; }

TEST(SpreadChanges, GivesEveryRowWhatAllThatWereAskedLack) {
  const Floor floor([](Vec2f) { return Rgb(0.02f, 0, -0.01f); });
  const std::vector<Rgb> spread = floor.spread();
  for (std::size_t row = 0; row < spread.size(); ++row) {
    EXPECT_NEAR(spread[row].r, floor.known[row] ? 0.0f : 0.02f, 1e-7f) << row;
    EXPECT_EQ(spread[row].g, 0.0f);
    EXPECT_NEAR(spread[row].b, floor.known[row] ? 0.0f : -0.01f, 1e-7f) << row;
  }
}

TEST(SpreadChanges, FollowsWhatChangesSlowly) {
  const auto change = [](Vec2f at) { return Rgb(std::sin(at.x / 20) + std::cos(at.y / 25)); };
  const Floor floor(change);
  const std::vector<Rgb> spread = floor.spread();
  double left = 0, all = 0;
  for (std::size_t y = 8; y + 8 < kFloorSide; ++y)
    for (std::size_t x = 8; x + 8 < kFloorSide; ++x) {
      const std::size_t row = row_at(x, y);
      if (floor.known[row]) continue;
      const double is = static_cast<double>(change(floor.pixel[row]).g);
      left += std::pow(static_cast<double>(spread[row].g) - is, 2), all += is * is;
    }
  EXPECT_LT(std::sqrt(left / all), 0.03);
}

TEST(SpreadChanges, NotFromOneSurfaceToAnother) {
  // The right half is a wall, at whose rows nothing is lacking; and one that shows nothing at all.
  Floor floor([](Vec2f at) { return Rgb(at.x < 24 ? 1.0f : 0.0f); });
  for (std::size_t y = 0; y < kFloorSide; ++y)
    for (std::size_t x = 24; x < kFloorSide; ++x) {
      const std::size_t row = row_at(x, y);
      floor.normal[row] = {1, 0, 0.01f};
      floor.position[row] = {24, static_cast<float>(y), static_cast<float>(x) - 24};
    }
  floor.normal[row_at(3, 3)] = {0, 0, 0};
  floor.position[row_at(40, 40)] = Vec3f{1, 1, 1} * std::numeric_limits<float>::infinity();
  const std::vector<Rgb> spread = floor.spread();
  EXPECT_EQ(spread[row_at(23, 20)], Rgb(1.0f));
  EXPECT_EQ(spread[row_at(24, 20)], Rgb(0.0f));
  EXPECT_EQ(spread[row_at(3, 3)], Rgb(0.0f));
  for (const Rgb& s : spread) EXPECT_TRUE(std::isfinite(s.r));
}

TEST(SpreadChanges, LessFromAStepBeside) {
  // Two levels of stairs with one normal: a row takes what its own level lacks, although the other is as
  // near.
  Floor floor([](Vec2f at) { return Rgb(at.x < 24 ? 1.0f : 0.0f); });
  for (std::size_t row = 0; row < floor.position.size(); ++row)
    if (floor.pixel[row].x > 24) floor.position[row].z = 20;
  const std::vector<Rgb> spread = floor.spread();
  EXPECT_GT(spread[row_at(23, 20)].r, 0.95f);
  EXPECT_LT(spread[row_at(24, 20)].r, 0.05f);
}

TEST(SpreadChanges, ByReflectance) {
  Floor floor([](Vec2f) { return Rgb(0.1f); });
  floor.albedo[row_at(10, 10)] = Rgb(0.25f, 0.5f, 1.0f);
  const Rgb there = floor.spread()[row_at(10, 10)];
  EXPECT_NEAR(there.r, 0.05f, 1e-6f);
  EXPECT_NEAR(there.g, 0.1f, 1e-6f);
  EXPECT_NEAR(there.b, 0.2f, 1e-6f);
}

TEST(SpreadChanges, NothingWhereNothingIsNear) {
  Floor floor([](Vec2f) { return Rgb(1); });
  floor.found.rows.resize(1), floor.found.change.resize(1);  // at 4, 4
  const std::vector<Rgb> spread = floor.spread();
  EXPECT_EQ(spread[row_at(6, 6)], Rgb(1));
  EXPECT_EQ(spread[row_at(30, 30)], Rgb(0));
  EXPECT_TRUE(spread_changes({}, {}, {}).empty());
}

}  // namespace
}  // namespace lumirank::methods
