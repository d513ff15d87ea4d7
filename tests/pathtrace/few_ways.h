// Scenes with few ways from the lamp to what the eye sees, and whether two ways to paint them agree in the
// mean.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "pathtrace/reference.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace lumirank::pathtrace {

using test::SceneMaker;

inline constexpr int kWidth = 12, kHeight = 8, kPicturesOfEach = 100;
// Pixels are large here, and what merging blurs must not be seen.
inline constexpr double kMergedPart = 0.1;

inline Transform ball(Vec3f center, double radius) {
  return Transform::translate(static_cast<double>(center.x), static_cast<double>(center.y),
                              static_cast<double>(center.z)) *
         Transform::scale(radius, radius, radius);
}

// A room with a box on its floor, seen from within.
inline SceneMaker room() {
  SceneMaker scene;
  scene.box_inside(1, scene.diffuse({0.7f, 0.6f, 0.5f}));
  scene.shape(scenedesc::CubeDesc{},
              Transform::translate(-0.4, -0.75, 0.3) * Transform::scale(0.25, 0.25, 0.25),
              scene.diffuse({0.3f, 0.6f, 0.4f}));
  scene.desc.sensors.push_back(
      test::sensor({0.1f, 0.2f, -0.95f}, {0, -0.2f, 1}, {0, 1, 0}, 80, kWidth, kHeight));
  return scene;
}

inline void add_ball_lamp(SceneMaker& scene, Vec3f center, double radius, float radiance) {
  auto& lamp = scene.shape(scenedesc::SphereDesc{}, ball(center, radius), scene.diffuse(Rgb(0)));
  scenedesc::AreaEmitterDesc emitter;
  emitter.radiance.value = Rgb(radiance, 0.8f * radiance, 0.6f * radiance);
  lamp.emitter = emitter;
}

inline scenedesc::MediumDesc fog(Rgb extinction, Rgb albedo, Rgb g) {
  scenedesc::MediumDesc medium;
  medium.extinction.value = extinction, medium.albedo.value = albedo;
  medium.phase.push_back({scenedesc::PhaseLobeDesc::Kind::henyey_greenstein, g, 1});
  return medium;
}

// Around the camera, and everything.
inline void fill(SceneMaker& scene, const scenedesc::MediumDesc& medium) {
  scene.desc.media.push_back(medium);
  scene.desc.sensors[0].medium = 0;
}

struct PixelMeans {
  std::vector<test::RunningMean> of = std::vector<test::RunningMean>(kWidth * kHeight);
  double variance() const {
    double sum = 0;
    for (const auto& m : of) sum += m.standard_error() * m.standard_error();
    return sum;
  }
};

inline PixelMeans means(const SceneMaker& maker, Paths paths, double light_paths, int pictures,
                        bool aim = false, double merged_pixels = kMergedPart) {
  SceneMaker scene = maker;
  const world::World world = scene.build();
  world::View view = world::make_view(scene.desc, {});
  PixelMeans sums;
  for (int k = 0; k < pictures; ++k) {
    ReferenceOptions options;
    options.seed = hash_ids(7, Stage::test, static_cast<std::uint64_t>(k), light_paths > 0 ? 1 : 0);
    options.paths = paths, options.light_paths = light_paths, options.aim_light_paths = aim;
    options.emission = false;  // seen directly it is alike in both
    options.merged_pixels = merged_pixels;
    PathFilm film(world, view, options);
    EXPECT_TRUE(film.add(8, {}));
    for (std::size_t p = 0; p < sums.of.size(); ++p)
      sums.of[p].add(static_cast<double>(luminance(film.result().image.pixels[p])));
  }
  return sums;
}

// All pixels agree, and together the whole: a false alarm once in a thousand runs.
inline void expect_same(const PixelMeans& alone, const PixelMeans& both, double teeth = 0.05) {
  const double z = test::normal_quantile(1e-3, alone.of.size());
  double a = 0, b = 0;
  for (std::size_t p = 0; p < alone.of.size(); ++p) {
    const auto &x = alone.of[p], &y = both.of[p];
    a += x.mean(), b += y.mean();
    EXPECT_NEAR(x.mean(), y.mean(), z * std::hypot(x.standard_error(), y.standard_error())) << "pixel " << p;
  }
  const double error = test::normal_quantile(1e-3) * std::sqrt(alone.variance() + both.variance());
  EXPECT_NEAR(a, b, error);
  EXPECT_LT(error, teeth * a) << "an error of that share would be seen";
}

}  // namespace lumirank::pathtrace
