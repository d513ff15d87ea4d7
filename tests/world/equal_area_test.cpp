// Environments of pbrt-v4: equal-area octahedral maps.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "image/image_io.h"
#include "world/equal_area.h"
#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using namespace test;

TEST(EqualArea, TheMiddleIsUpAndTheCornersAreDown) {
  EXPECT_EQ(sphere_to_square({0, 0, 1}), (Vec2f{0.5f, 0.5f}));
  EXPECT_EQ(sphere_to_square({0, 0, -1}), (Vec2f{1, 1}));
  EXPECT_EQ(sphere_to_square({1, 0, 0}), (Vec2f{1, 0.5f}));
  EXPECT_EQ(sphere_to_square({0, -1, 0}), (Vec2f{0.5f, 0}));
  EXPECT_EQ(sphere_to_square({-1, 0, 0}), (Vec2f{0, 0.5f}));
}

// A cap of height h has the share h/2 of the sphere and is the square |u| + |v| ≤ √h of area h/2 around the
// middle; in it, equal angles have equal areas.
TEST(EqualArea, AreasAreKept) {
  for (const float h : {0.1f, 0.5f, 0.9f})
    for (const float phi : {0.1f, 0.7f, 1.3f}) {
      const float s = std::sqrt(1 - (1 - h) * (1 - h));
      const Vec2f at = sphere_to_square({s * std::cos(phi), s * std::sin(phi), 1 - h});
      const float u = 2 * at.x - 1, v = 2 * at.y - 1;
      EXPECT_NEAR(u + v, std::sqrt(h), 1e-5f);
      EXPECT_NEAR(v / (u + v), phi / (kPi / 2), 1e-5f);
      const Vec2f below = sphere_to_square({s * std::cos(phi), s * std::sin(phi), h - 1});
      EXPECT_NEAR(2 * below.x - 1, 1 - v, 1e-5f);  // mirrored at the square's edge
      EXPECT_NEAR(2 * below.y - 1, 1 - u, 1e-5f);
    }
}

TEST(EqualArea, ResamplingKeepsTheMeanAndTheIlluminanceOfTheSky) {
  image::Image square(32, 32, Rgb(0.5f));
  square.at(20, 9) = Rgb(900, 0, 3);  // a small sun
  const image::Image map = to_latitude_longitude(square);
  EXPECT_EQ(map.width, 64);
  EXPECT_EQ(map.height, 32);
  double sum = 0, all = 0;
  for (int y = 0; y < 32; ++y) {
    const double weight = std::cos(M_PI * y / 32) - std::cos(M_PI * (y + 1) / 32);
    for (int x = 0; x < 64; ++x) sum += weight * map.at(x, y).r, all += weight;
  }
  EXPECT_NEAR(sum / all, (0.5 * 1023 + 900) / 1024, 1e-4);
  EXPECT_NEAR(illuminance_of_pole(image::Image(8, 4, Rgb(2))), 2 * M_PI, 1e-5);
}

// Of this process alone: tests run side by side.
const std::string kFile =
    ::testing::TempDir() + "lumirank_world_equal_area_" + std::to_string(getpid()) + ".pfm";

World sky(const image::Image& image, const sd::EnvironmentMapDesc& map,
          std::vector<sd::Warning>* warnings = nullptr) {
  image::write_image(kFile, {image, {}});
  auto desc = empty_scene();
  add_shape(desc, sd::RectangleDesc{});
  add_emitter(desc, map);
  World world = build(desc, warnings);
  std::remove(kFile.c_str());
  return world;
}

sd::EnvironmentMapDesc octahedral() {
  sd::EnvironmentMapDesc map;
  map.filename = kFile;
  map.projection = sd::EnvironmentProjection::equal_area;
  return map;
}

TEST(EqualArea, DirectionsOfTheWorldReadTheirTexels) {
  // Red to the right (u > ½: +x), green in the lower rows of the file (v > ½: +y), blue in the diamond (+z).
  image::Image image(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      image.at(x, y) = Rgb(x >= 32, y >= 32, std::abs(x - 31.5f) + std::abs(y - 31.5f) < 32);
  sd::EnvironmentMapDesc map = octahedral();
  map.scale = 2;
  const World plain = sky(image, map);
  map.to_world = Transform::scale(-1, 1, 1);
  const World mirrored = sky(image, map);
  for (const Vec3f d : {Vec3f{1, 2, 3}, {-1, 2, 3}, {1, -2, 3}, {1, 2, -3}, {-3, -1, -1}, {-2, -1, 1}}) {
    const Rgb want(d.x > 0 ? 2 : 0, d.y > 0 ? 2 : 0, d.z > 0 ? 2 : 0);
    // All of a channel is scaled to keep its mean, which 36 points per texel find to within 2 ‰ here: only
    // the texels at the edges of the three areas hold any error, about 1/64 of them, of about ⅙ / √36 each.
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(plain.background(normalize(d))[k], want[k], 4e-3f) << k;
      EXPECT_NEAR(mirrored.background(normalize(Vec3f{-d.x, d.y, d.z}))[k], want[k], 4e-3f) << k;
    }
  }
}

TEST(EqualArea, IlluminanceIsWhatPbrtMakesOfIt) {
  sd::EnvironmentMapDesc map = octahedral();
  map.illuminance = 100;
  // pbrt finds π/2 for a sky of 1.
  EXPECT_NEAR(sky(image::Image(16, 16, Rgb(3)), map).background({0, 0, 1}).g, 200 / M_PI, 1e-3);
  EXPECT_THROW(sky(image::Image(16, 16), map), InputError);
}

// Illuminance is that of the map before.
TEST(EqualArea, TintIsOnTopOfEverything) {
  sd::EnvironmentMapDesc map = octahedral();
  map.illuminance = 100, map.tint = Rgb(2, 1, 0.5f);
  for (const auto projection :
       {sd::EnvironmentProjection::equal_area, sd::EnvironmentProjection::latitude_longitude}) {
    map.projection = projection;
    const Rgb seen = sky(image::Image(16, 16, Rgb(3)), map).background({0, 0, 1});
    const float gray = projection == sd::EnvironmentProjection::equal_area ? 200 / kPi : 3;
    EXPECT_NEAR(seen.r, 2 * gray, 1e-3f * gray);
    EXPECT_NEAR(seen.g, gray, 1e-3f * gray);
    EXPECT_NEAR(seen.b, 0.5f * gray, 1e-3f * gray);
  }
}

TEST(EqualArea, OtherPicturesAreLatitudesAndLongitudesWithAWarning) {
  image::Image image(8, 4);
  image.at(1, 0) = Rgb(5);  // longitude 1.5/8 · 2π from +x towards +y, latitude 1/8 · π from +z
  std::vector<sd::Warning> warnings;
  const World world = sky(image, octahedral(), &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].what.find("not square"), std::string::npos);
  const float phi = 1.5f / 8 * 2 * kPi, theta = kPi / 8;
  EXPECT_NEAR(
      world.background({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}).r,
      5, 1e-3f);
  EXPECT_EQ(world.background({0, 0, -1}).r, 0);
}

}  // namespace
}  // namespace lumirank::world
