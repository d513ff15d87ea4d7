// Passes of interleaved pixels show what whole passes show.
#include "pipeline/pass_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/scenes.h"
#include "support/statistics.h"

namespace lumirank::pipeline {
namespace {

constexpr int kWidth = 24, kHeight = 16;

// A lamp above a floor and a wall, and a blocker.
test::SceneMaker corner() {
  test::SceneMaker scene;
  scene.rectangle({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, scene.diffuse(Rgb(0.6f)));
  scene.rectangle({0, 2, 2}, {2, 0, 0}, {0, 2, 0}, scene.diffuse({0.7f, 0.3f, 0.2f}));
  scene.rectangle({0.5f, 0.8f, 0}, {0.3f, 0, 0}, {0, 0, -0.3f}, scene.diffuse(Rgb(0.5f)));
  scenedesc::AreaEmitterDesc emitter;
  emitter.radiance.value = Rgb(8);
  scene
      .shape(scenedesc::SphereDesc{}, Transform::translate(0, 2, 0) * Transform::scale(0.2, 0.2, 0.2),
             scene.diffuse(Rgb(0)))
      .emitter = emitter;
  scene.desc.sensors.push_back(test::sensor({0, 2, -4}, {0, 0.7f, 0}, {0, 1, 0}, 50, kWidth, kHeight));
  return scene;
}

// Light of all pixels together, by so many films of passes.
std::vector<double> light_of_films(int side, int films) {
  test::SceneMaker scene = corner();
  const auto world = std::make_shared<const world::World>(scene.build());
  View view = world::make_view(scene.desc, {});
  view.sensor.film.filter = scenedesc::FilterDesc{.kind = scenedesc::FilterKind::box};
  RenderSettings settings;
  settings.seed = static_cast<std::uint64_t>(side);
  const methods::MethodInfo& info = methods::find_method("row-guided-sampling");
  std::map<std::string, double> seconds;
  PassTracer tracer(world, info, info.make({}), settings, {}, seconds);
  tracer.aim(survey(world, view, tracer.recipe_of(0, view), {}));
  tracer.interleave(side);
  std::vector<double> light(static_cast<std::size_t>(films));
  for (int k = 0; k < films * tracer.parts(); ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    image::Image image;
    PassSeconds took;
    EXPECT_TRUE(tracer.trace(number, view, image, took));
    const film::PixelLattice pixels = tracer.recipe_of(number, view).pixels;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (!pixels.has(x, y)) {
          EXPECT_EQ(image.at(x, y), Rgb(0));
        }
        light[static_cast<std::size_t>(k / tracer.parts())] += image.at(x, y).g;
      }
  }
  return light;
}

TEST(PassTracer, InterleavedPixelsHaveTheMeanOfWholePasses) {
  const auto whole = test::mean_of(light_of_films(1, 60)), parts = test::mean_of(light_of_films(2, 60));
  EXPECT_GT(whole.mean, 0);
  EXPECT_LT(whole.standard_error, 0.02 * whole.mean);
  EXPECT_LT(parts.standard_error, 0.02 * parts.mean);
  EXPECT_LT(std::abs(whole.mean - parts.mean),
            test::normal_quantile(1e-4) * std::hypot(whole.standard_error, parts.standard_error));
}

}  // namespace
}  // namespace lumirank::pipeline
