// Light paths merged with eye paths behind mirrors and glass: who is near is found, and the picture is the
// same in the mean.
#include "pathtrace/vertex_merging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "pathtrace/few_ways.h"

namespace lumirank::pathtrace {
namespace {

MergePoint merge_point(Vec3f place, Vec3f normal, float radius) {
  MergePoint point;
  point.hit.point.position = place, point.hit.point.ng = normal;
  point.area = kPi * radius * radius;
  return point;
}

scatter::SurfacePoint surface_point(Vec3f place, Vec3f normal) {
  scatter::SurfacePoint point;
  point.position = place, point.ng = normal;
  return point;
}

std::vector<std::uint32_t> pixels_around(const MergePoints& points, const scatter::SurfacePoint& at) {
  std::vector<std::uint32_t> pixels;
  std::vector<const MergePoint*> found;
  points.around(at, found);
  for (const MergePoint* point : found) pixels.push_back(point->pixel);
  std::sort(pixels.begin(), pixels.end());
  return pixels;
}

TEST(MergePoints, AllDiscsOfAPlaceAreFoundOnce) {
  // Discs of a plane, of radii over four orders, and on both sides of zero.
  Rng random(3, Stage::test);
  std::vector<std::vector<MergePoint>> parts(3);
  for (std::uint32_t k = 0; k < 3000; ++k) {
    const Vec2f at = random.next_2d();
    MergePoint point =
        merge_point({4 * at.x - 2, 4 * at.y - 2, 0}, {0, 0, 1}, 0.5f * std::pow(1e-4f, random.next_float()));
    point.pixel = k;
    parts[k % 3].push_back(point);
  }
  const MergePoints points(parts);
  std::size_t found = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec2f at = random.next_2d();
    const Vec3f place{4 * at.x - 2, 4 * at.y - 2, 0};
    std::vector<std::uint32_t> expected;
    for (const auto& part : parts)
      for (const MergePoint& point : part)
        if (kPi * length_squared(place - point.hit.point.position) <= point.area)
          expected.push_back(point.pixel);
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(pixels_around(points, surface_point(place, {0, 0, 1})), expected);
    found += expected.size();
  }
  EXPECT_GT(found, 1000);
}

TEST(MergePoints, OtherSurfacesAreNotMerged) {
  const std::vector<std::vector<MergePoint>> parts{{merge_point({1, 2, 3}, {0, 0, 1}, 0.1f)}};
  const MergePoints points(parts);
  const auto found = [&](Vec3f place, Vec3f normal) {
    return pixels_around(points, surface_point(place, normal)).size() == 1;
  };
  EXPECT_TRUE(found({1.05f, 2, 3}, {0, 0, 1}));
  EXPECT_TRUE(found({1.05f, 2, 3}, {0, 0, -1}));  // which side counts is for the BSDF to say
  EXPECT_FALSE(found({1.05f, 2, 3}, {1, 0, 0}));
  EXPECT_FALSE(found({1, 2, 3.07f}, {0, 0, 1}));  // a sheet above it
  EXPECT_FALSE(found({1.2f, 2, 3}, {0, 0, 1}));
  EXPECT_TRUE(pixels_around(MergePoints(), surface_point({1, 2, 3}, {0, 0, 1})).empty());
}

// A bulb in glass, and a wall that is a mirror.
SceneMaker bulb_and_mirror() {
  SceneMaker scene = room();
  add_ball_lamp(scene, {0.3f, 0.4f, 0.2f}, 0.18, 20);
  scene.shape(scenedesc::SphereDesc{}, ball({0.3f, 0.4f, 0.2f}, 0.25), scene.glass(1.5f));
  scene.rectangle({0, 0, 0.97f}, {0.97f, 0, 0}, {0, -0.97f, 0}, scene.mirror(Rgb(0.9f)));
  return scene;
}

// The floor of a tank of water under a large sun, seen from above.
SceneMaker pool_in_the_sun() {
  SceneMaker scene;
  scene.rectangle({0, -0.5f, 0}, {1, 0, 0}, {0, 0, -1}, scene.diffuse({0.5f, 0.6f, 0.7f}));
  scene.rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, -1}, scene.glass(1.33f));
  scenedesc::SunSkyDesc sun;
  sun.sky = false, sun.sun_radius_scale = 50;
  sun.sun_direction = Vec3f{-0.5f, 0.8f, 0.2f};
  scene.light(sun);
  scene.desc.sensors.push_back(test::sensor({0.2f, 1.2f, -1}, {0.15f, 0, 0}, {0, 1, 0}, 40, kWidth, kHeight));
  return scene;
}

TEST(VertexMerging, WhatAMirrorShowsOfABulbInGlassIsTheSameWithHalfTheVariance) {
  const auto alone = means(bulb_and_mirror(), Paths::all, 0, kPicturesOfEach),
             both = means(bulb_and_mirror(), Paths::all, 1, kPicturesOfEach, false, 0.3),
             seen_alone = means(bulb_and_mirror(), Paths::all, 1, kPicturesOfEach, false, 0);
  expect_same(alone, both, 0.1);
  EXPECT_LT(both.variance(), seen_alone.variance() / 2);
}

TEST(VertexMerging, TheRestOfItIsTheSame) {
  expect_same(means(bulb_and_mirror(), Paths::rest, 0, kPicturesOfEach),
              means(bulb_and_mirror(), Paths::rest, 1, kPicturesOfEach), 0.1);
}

TEST(VertexMerging, AFloorUnderWaterIsTheSameWithAFifthOfTheVariance) {
  const auto alone = means(pool_in_the_sun(), Paths::all, 0, kPicturesOfEach),
             both = means(pool_in_the_sun(), Paths::all, 1, kPicturesOfEach, true, 1);
  expect_same(alone, both, 0.1);
  EXPECT_LT(both.variance(), alone.variance() / 5);
}

TEST(VertexMerging, ALimitOfDepthCountsBothParts) {
  SceneMaker scene = bulb_and_mirror();
  for (const int depth : {4, 5, 6}) {
    scene.desc.max_depth = depth;
    expect_same(means(scene, Paths::all, 0, kPicturesOfEach), means(scene, Paths::all, 1, kPicturesOfEach),
                0.2);
  }
}

TEST(VertexMerging, WhatAMirrorShowsInThinFogIsTheSame) {
  SceneMaker scene = bulb_and_mirror();
  fill(scene, fog({0.2f, 0.15f, 0.1f}, Rgb(0.8f), Rgb(0.3f)));
  // Once in a while a path of fog finds the bulb as bright as all others together.
  expect_same(means(scene, Paths::all, 0, 3 * kPicturesOfEach),
              means(scene, Paths::all, 1, 3 * kPicturesOfEach, false, 0.5), 0.1);
}

TEST(VertexMerging, AnyNumberOfThreadsGivesTheSameBits) {
  SceneMaker scene = bulb_and_mirror();
  const world::World world = scene.build();
  const world::View view = world::make_view(scene.desc, {});
  const auto picture = [&](int threads) {
    image::Image image;
    with_threads(threads, [&] {
      ReferenceOptions options;
      options.light_paths = 2;
      PathFilm film(world, view, options);
      EXPECT_TRUE(film.add(3, {}));
      image = film.result().image;
    });
    return image;
  };
  EXPECT_EQ(picture(1).pixels, picture(3).pixels);
}

}  // namespace
}  // namespace lumirank::pathtrace
