#include "pipeline/light_path_pilot.h"

#include <gtest/gtest.h>

#include <memory>

#include "lumirank/lumirank.h"
#include "pipeline/rest_tracing.h"
#include "support/scenes.h"

namespace lumirank::pipeline {
namespace {

// A floor, and a lamp in a ball of glass above it or a sky.
test::SceneMaker floor_under(bool bulb) {
  test::SceneMaker scene;
  scene.rectangle({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, scene.diffuse(Rgb(0.6f)));
  const auto ball = [](double radius) {
    return Transform::translate(0, 1, 0) * Transform::scale(radius, radius, radius);
  };
  if (bulb) {
    scenedesc::AreaEmitterDesc emitter;
    emitter.radiance.value = Rgb(50);
    scene.shape(scenedesc::SphereDesc{}, ball(0.05), scene.diffuse(Rgb(0))).emitter = emitter;
    scene.shape(scenedesc::SphereDesc{}, ball(0.2), scene.glass(1.5f));
  } else {
    scene.light(scenedesc::ConstantEnvironmentDesc{Rgb(1)});
  }
  scene.desc.sensors.push_back(test::sensor({0, 2, -3}, {0, 0.5f, 0}, {0, 1, 0}, 60, 64, 48));
  return scene;
}

LightPathPilot pilot(bool bulb, int width, int crop) {
  test::SceneMaker scene = floor_under(bulb);
  scene.desc.sensors[0].film.width = width, scene.desc.sensors[0].film.height = 3 * width / 4;
  const world::World world = scene.build();
  world::ViewChoice choice;
  choice.crop[2] = choice.crop[3] = crop;
  return pilot_light_paths(world, world::make_view(scene.desc, choice), 1, pathtrace::Paths::all, 0, {});
}

TEST(LightPathPilot, ABulbInGlassIsWorthLightPathsAndASkyIsNot) {
  const LightPathPilot bulb = pilot(true, 64, 0), sky = pilot(false, 64, 0);
  EXPECT_GE(bulb.light_paths, 1);
  EXPECT_LT(bulb.variance, 0.1);
  EXPECT_GT(bulb.seconds, 1);
  EXPECT_EQ(sky.light_paths, 0);
  EXPECT_EQ(sky.variance, 1);
}

TEST(LightPathPilot, WhatCannotBeKnownInTimeIsNone) {
  test::SceneMaker scene = floor_under(true);
  const world::World world = scene.build();
  const auto in_seconds = [&](double time) {
    return pilot_light_paths(world, world::make_view(scene.desc, {}), 1, pathtrace::Paths::all, time, {});
  };
  EXPECT_GE(in_seconds(1e6).light_paths, 1);
  EXPECT_EQ(in_seconds(1e-9).light_paths, 0);
}

TEST(LightPathPilot, ASunOnASmallBallOfGlassIsWorthAimedOnes) {
  test::SceneMaker scene;
  scene.rectangle({0, 0, 0}, {9, 0, 0}, {0, 0, -9}, scene.diffuse(Rgb(0.6f)));
  scene.shape(scenedesc::SphereDesc{}, Transform::translate(0, 0.4, 0) * Transform::scale(0.3, 0.3, 0.3),
              scene.glass(1.5f));
  scenedesc::SunSkyDesc sun;
  sun.sun_direction = Vec3f{-0.5f, 0.8f, 0.2f};
  scene.light(sun);
  scene.desc.sensors.push_back(test::sensor({0, 1.5f, -2}, {0.1f, 0.2f, 0}, {0, 1, 0}, 45, 64, 48));
  const world::World world = scene.build();
  const LightPathPilot found =
      pilot_light_paths(world, world::make_view(scene.desc, {}), 1, pathtrace::Paths::all, 0, {});
  EXPECT_GT(found.light_paths, 0);
  EXPECT_TRUE(found.aim);
  EXPECT_LT(found.left, 0.7);
}

// A tiny lamp shines up at a mirror that lights the floor; a larger one keeps it from being all light there
// is.
test::SceneMaker lamp_below_a_mirror(float radiance) {
  test::SceneMaker scene;
  scene.rectangle({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, scene.diffuse(Rgb(0.6f)));
  scene.rectangle({0, 1, 0}, {0.04f, 0, 0}, {0, 0, 0.04f}, scene.mirror(Rgb(0.9f)));
  scene.lamp({0, 0.98f, 0}, {0, 0, 0.001f}, {0.001f, 0, 0}, Rgb(radiance), scene.diffuse(Rgb(0)));
  scene.lamp({0, 3, 0}, {1, 0, 0}, {0, 0, 1}, Rgb(0.5f), scene.diffuse(Rgb(0)));
  scene.desc.sensors.push_back(test::sensor({0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 50, 64, 48));
  return scene;
}
constexpr float kBright = 3e5f, kFaint = 3e2f;

RestTracing rest_of(float radiance) {
  test::SceneMaker scene = lamp_below_a_mirror(radiance);
  const auto world = std::make_shared<const world::World>(scene.build());
  return RestTracing(world, world::make_view(scene.desc, {}), RenderSettings{}, {});
}

// The pilot's eye paths do not find the small lamp, its light paths do, and the light is not left out.
TEST(RestPlan, TracesWhatOnlyLightPathsFind) {
  const RestTracing bright = rest_of(kBright), faint = rest_of(kFaint);
  EXPECT_FALSE(bright.plan().pilot.matters());
  EXPECT_GT(bright.plan().paths, 0);
  EXPECT_GT(bright.plan().light_paths, 0);
  EXPECT_EQ(faint.plan().paths, 0);
  EXPECT_EQ(faint.plan().light_paths, 0);
}

// Frames of a shot have the light paths of the first, whatever their own pilots say.
TEST(RestPlan, IsRepeatedAsAChoice) {
  RestTracing first = rest_of(kBright), second = rest_of(kFaint);
  methods::TimedChoices made;
  first.choose(made);
  methods::TimedChoices again(made.made());
  second.choose(again);
  EXPECT_EQ(second.plan().paths, first.plan().paths);
  EXPECT_EQ(second.light_paths(), first.light_paths());
  EXPECT_EQ(second.aims_light_paths(), first.aims_light_paths());
  again.expect_end();
  EXPECT_EQ(again.made(), made.made());
}

TEST(LightPathPilot, IsOfTheWholeFilmAtOneSize) {
  const LightPathPilot whole = pilot(true, 64, 0);
  for (const LightPathPilot& other : {pilot(true, 64, 8), pilot(true, 640, 0)}) {
    EXPECT_EQ(other.light_paths, whole.light_paths);
    EXPECT_EQ(other.variance, whole.variance);
  }
}

}  // namespace
}  // namespace lumirank::pipeline
