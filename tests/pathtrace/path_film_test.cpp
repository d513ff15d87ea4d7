#include <gtest/gtest.h>

#include <cmath>

#include "pathtrace/reference.h"
#include "support/scenes.h"

namespace lumirank::pathtrace {
namespace {

using image::Image;

double sum_of(const Image& image) {
  double sum = 0;
  for (const Rgb& c : image.pixels) sum += static_cast<double>(c.r + c.g + c.b);
  return sum;
}

test::SceneMaker box_with_lamp() {
  test::SceneMaker scene;
  scene.box_inside(1, scene.diffuse({0.7f, 0.6f, 0.5f}));
  scene.lamp({0, 0.2f, 0.9f}, {0, 0.3f, 0}, {0.3f, 0, 0}, Rgb(4), scene.diffuse(Rgb(0.2f)));
  scene.desc.sensors.push_back(test::sensor({0, 0, -0.9f}, {0, 0, 1}, {0, 1, 0}, 80, 12, 8));
  return scene;
}

// A lamp is seen: the paths that end there are the same that surfaces' light comes by.
TEST(PathFilm, WhatSurfacesSendIsAllButEmission) {
  test::SceneMaker scene = box_with_lamp();
  const world::World world = scene.build();
  const world::View view = world::make_view(scene.desc, {});
  ReferenceOptions options;
  options.light_paths = 1;
  PathFilm all(world, view, options);
  options.emission = false;
  PathFilm surfaces(world, view, options);
  ASSERT_TRUE(all.add(6, {}) && surfaces.add(6, {}));
  const Image sent = all.sent(), difference = all.sent_difference(), other = surfaces.halves_difference();
  EXPECT_GT(sum_of(all.result().image), 1.2 * sum_of(sent)) << "the lamp is seen";
  for (std::size_t p = 0; p < sent.pixels.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(sent.pixels[p][c], surfaces.result().image.pixels[p][c]);
      EXPECT_EQ(difference.pixels[p][c], other.pixels[p][c]);
    }
}

// Beneath a sky, whose map has many texels, among a matt floor, a mirror, glass and a lamp: paths end after
// one step and after many.
TEST(PathTracer, PathsTracedTogetherAreAsIfAlone) {
  test::SceneMaker scene;
  scene.rectangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, scene.diffuse({0.7f, 0.6f, 0.5f}));
  scene.rectangle({0, 1, 1}, {1, 0, 0}, {0, 0, -1}, scene.mirror(Rgb(0.9f)));
  scene.rectangle({0, -1, 1}, {1, 0, 0}, {0, 0, 1}, scene.glass(1.5f));
  scene.lamp({0, 0, 1.5f}, {0, 0.3f, 0}, {0.3f, 0, 0}, Rgb(4), scene.diffuse(Rgb(0.2f)));
  scene.light(scenedesc::SunSkyDesc{});
  const world::World world = scene.build();
  const PathTracer tracer(world, PathSettings{3, -1, Paths::all, {}});
  std::vector<PathTracer::Start> starts;
  for (std::uint32_t k = 0; k < 40; ++k) {
    const float x = 0.05f * static_cast<float>(k) - 1;
    starts.push_back({{{0.3f * x, -0.9f, 0.8f}, normalize(Vec3f{0.2f * x, 1, x})}, k, k % 3});
  }
  std::vector<Radiance> together(starts.size());
  tracer.trace(starts, together);
  float light = 0;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const Radiance alone = tracer.trace(starts[k].ray, starts[k].place, starts[k].sample);
    light += alone.total().r;
    EXPECT_EQ(together[k].emission, alone.emission);
    EXPECT_EQ(together[k].direct, alone.direct);
    EXPECT_EQ(together[k].indirect, alone.indirect);
    EXPECT_EQ(together[k].segments, alone.segments);
  }
  EXPECT_GT(light, 0);
}

// What pixels say of their own noise, against what pictures by other paths differ by. Paths of a pixel are
// spread evenly, so they differ by no more.
TEST(PathFilm, DeviationIsThatOfOtherPaths) {
  test::SceneMaker scene = box_with_lamp();
  const world::World world = scene.build();
  const world::View view = world::make_view(scene.desc, {});
  constexpr int kPictures = 48;
  double told = 0, sum[96] = {}, squares[96] = {};
  for (int k = 0; k < kPictures; ++k) {
    ReferenceOptions options;
    options.seed = 100 + static_cast<std::uint64_t>(k);
    options.light_paths = 1;
    PathFilm film(world, view, options);
    ASSERT_TRUE(film.add(16, {}));
    const Image sent = film.sent();
    const std::vector<float> deviation = film.sent_deviation();
    ASSERT_EQ(deviation.size(), 96u);
    for (std::size_t p = 0; p < 96; ++p) {
      const auto y = static_cast<double>(luminance(sent.pixels[p]));
      sum[p] += y, squares[p] += y * y;
      told += std::pow(static_cast<double>(deviation[p]), 2) / kPictures;
    }
  }
  double found = 0;
  for (int p = 0; p < 96; ++p) found += (squares[p] - sum[p] * sum[p] / kPictures) / (kPictures - 1);
  EXPECT_GT(told, 0.8 * found);
  EXPECT_LT(told, 2.5 * found);
}

}  // namespace
}  // namespace lumirank::pathtrace
