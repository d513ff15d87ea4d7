// Light paths beside eye paths: the same picture in the mean, whatever carries a path's light, with less
// noise where eye paths find it by chance.
#include "pathtrace/light_tracer.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "base/warp.h"
#include "pathtrace/few_ways.h"
#include "pathtrace/light_targets.h"

namespace lumirank::pathtrace {
namespace {

using test::SceneMaker;

SceneMaker bulb_in_glass() {
  SceneMaker scene = room();
  add_ball_lamp(scene, {0.3f, 0.4f, 0.2f}, 0.18, 20);
  scene.shape(scenedesc::SphereDesc{}, ball({0.3f, 0.4f, 0.2f}, 0.25), scene.glass(1.5f));
  return scene;
}

// Under a shade that is open above, the ceiling lights the room.
SceneMaker shaded_lamp() {
  SceneMaker scene = room();
  scene.lamp({0.2f, 0.5f, 0.3f}, {0.1f, 0, 0}, {0, 0, -0.1f}, Rgb(30), scene.diffuse(Rgb(0)));
  return scene;
}

SceneMaker spot_on_a_mirror() {
  SceneMaker scene = room();
  scene.rectangle({0, -0.9f, 0.2f}, {0.5f, 0, 0}, {0, 0, 0.5f}, scene.mirror(Rgb(0.9f)));
  scenedesc::SpotLightDesc spot;
  spot.to_world = Transform::look_at({0, 0.8, 0.2}, {0.2, -1, 0.3}, {1, 0, 0});
  spot.intensity = Rgb(2);
  spot.cutoff_angle = 40, spot.beam_width = 20;
  scene.light(spot);
  return scene;
}

// Rough metal before the lamp, and rough metal before the eye; a sky comes in where a wall is missing.
SceneMaker gloss() {
  SceneMaker scene;
  const int white = scene.diffuse(Rgb(0.6f));
  scenedesc::ConductorDesc metal;
  metal.alpha_u = metal.alpha_v = {0.2f};
  const int rough = scene.bsdf(metal);
  scene.rectangle({0, -1, 0}, {1, 0, 0}, {0, 0, -1}, rough);
  scene.rectangle({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, white);
  scene.rectangle({0, 0, 1}, {1, 0, 0}, {0, -1, 0}, white);
  scene.rectangle({-1, 0, 0}, {0, 0, -1}, {0, 1, 0}, rough);
  scene.light(scenedesc::ConstantEnvironmentDesc{Rgb(0.5f)});
  add_ball_lamp(scene, {0.5f, 0.2f, 0.3f}, 0.1, 20);
  scene.desc.sensors.push_back(
      test::sensor({0.3f, 0.3f, -2.5f}, {0, -0.2f, 1}, {0, 1, 0}, 45, kWidth, kHeight));
  return scene;
}

// A sun of 27 degrees, so that eye paths find it, on a small ball of glass, seen on a wide floor.
SceneMaker ball_in_the_sun() {
  SceneMaker scene;
  scene.rectangle({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, scene.diffuse({0.6f, 0.5f, 0.4f}));
  scene.shape(scenedesc::SphereDesc{}, ball({0, 0.3f, 0}, 0.25), scene.glass(1.5f));
  scenedesc::SunSkyDesc sun;
  sun.sky = false, sun.sun_radius_scale = 50;
  sun.sun_direction = Vec3f{-0.5f, 0.8f, 0.2f};
  scene.light(sun);
  scene.desc.sensors.push_back(
      test::sensor({0.2f, 1.2f, -1.5f}, {0.15f, 0.1f, 0}, {0, 1, 0}, 40, kWidth, kHeight));
  return scene;
}

TEST(LightTracer, ABulbInGlassIsTheSameWithAThirdOfTheVariance) {
  const auto alone = means(bulb_in_glass(), Paths::all, 0, kPicturesOfEach),
             both = means(bulb_in_glass(), Paths::all, 1, kPicturesOfEach);
  expect_same(alone, both);
  EXPECT_LT(both.variance(), alone.variance() / 3);
}

TEST(LightTracer, TheRestOfABulbInGlassIsTheSame) {
  const auto alone = means(bulb_in_glass(), Paths::rest, 0, kPicturesOfEach),
             both = means(bulb_in_glass(), Paths::rest, 1, kPicturesOfEach);
  expect_same(alone, both, 0.1);
  EXPECT_LT(both.variance(), alone.variance() / 3);
}

TEST(LightTracer, ALampThatLightsTheCeilingIsTheSame) {
  const auto alone = means(shaded_lamp(), Paths::all, 0, kPicturesOfEach),
             both = means(shaded_lamp(), Paths::all, 1, kPicturesOfEach);
  expect_same(alone, both);
  EXPECT_LT(both.variance(), alone.variance());
}

TEST(LightTracer, ASpotOnAMirrorIsTheSame) {
  expect_same(means(spot_on_a_mirror(), Paths::all, 0, kPicturesOfEach),
              means(spot_on_a_mirror(), Paths::all, 2, kPicturesOfEach));
}

TEST(LightTracer, RoughMetalAndASkyAreTheSame) {
  expect_same(means(gloss(), Paths::all, 0, kPicturesOfEach),
              means(gloss(), Paths::all, 0.5, kPicturesOfEach));
}

TEST(LightTracer, ASunThroughGlassIsTheSameWithAFifthOfTheVarianceWhereItIsAimed) {
  const auto alone = means(ball_in_the_sun(), Paths::all, 0, kPicturesOfEach),
             aimed = means(ball_in_the_sun(), Paths::all, 1, kPicturesOfEach, true);
  expect_same(alone, aimed);
  EXPECT_LT(aimed.variance(), alone.variance() / 5);
}

TEST(LightTracer, WhatIsAimedIsTheSameFromEveryEmitter) {
  for (const auto& scene : {bulb_in_glass(), spot_on_a_mirror(), gloss()})
    expect_same(means(scene, Paths::all, 0, kPicturesOfEach),
                means(scene, Paths::all, 1, kPicturesOfEach, true));
}

// A large lamp before the wall behind the eye, of which it takes the place where it is seen.
SceneMaker lamp_behind_the_eye(bool seen) {
  SceneMaker scene = room();
  auto& lamp = scene.lamp({0, 0.3f, -0.97f}, {0.5f, 0, 0}, {0, 0.5f, 0}, Rgb(3),
                          seen ? 0 : scene.bsdf(scenedesc::NullBsdfDesc{}));
  lamp.emitter->seen = seen;
  return scene;
}

TEST(LampThatCannotBeSeen, LightsAsMuchAsOneThatCan) {
  expect_same(means(lamp_behind_the_eye(true), Paths::all, 0, kPicturesOfEach),
              means(lamp_behind_the_eye(false), Paths::all, 0, kPicturesOfEach));
}

TEST(LampThatCannotBeSeen, NoRayMeetsIt) {
  const Vec3f eye{0.2f, 0.6f, 0}, to_lamp{0, 0, -1};
  for (const bool seen : {true, false}) {
    const world::World world = lamp_behind_the_eye(seen).build();
    const PathTracer tracer(world, {});
    const Vec3f from = world.units().to_world(
        Vec3d{static_cast<double>(eye.x), static_cast<double>(eye.y), static_cast<double>(eye.z)});
    test::RunningMean indirect;
    for (std::uint64_t k = 0; k < 200; ++k) {
      const Radiance radiance = tracer.trace({from, to_lamp}, k, 0);
      EXPECT_EQ(radiance.emission.r > 0, seen);
      indirect.add(static_cast<double>(luminance(radiance.indirect)));
    }
    EXPECT_GT(indirect.mean(), 0);  // of the wall behind it, or its own
  }
}

// Eye paths carry all that it sends, and share what a bulb in glass sends.
TEST(LampThatCannotBeSeen, LeavesItsLightToEyePaths) {
  SceneMaker scene = lamp_behind_the_eye(false);
  add_ball_lamp(scene, {0.3f, 0.4f, 0.2f}, 0.18, 20);
  scene.shape(scenedesc::SphereDesc{}, ball({0.3f, 0.4f, 0.2f}, 0.25), scene.glass(1.5f));
  expect_same(means(scene, Paths::all, 0, kPicturesOfEach), means(scene, Paths::all, 1, kPicturesOfEach));
}

TEST(LightTargets, AreWhatSendsLightOnSharply) {
  SceneMaker scene = room();
  const world::World room_alone = scene.build();
  EXPECT_TRUE(LightTargets(room_alone, {0, 0, 0}).empty());
  scene.shape(scenedesc::SphereDesc{}, ball({0.5f, 0, 0.5f}, 0.1), scene.glass(1.5f));
  scene.shape(scenedesc::SphereDesc{}, ball({-0.5f, 0, 0.5f}, 0.2), scene.mirror(Rgb(0.8f)));
  const world::World world = scene.build();
  const LightTargets targets(world, {0, 0, -0.9f});
  ASSERT_EQ(targets.size(), 2u);
  const auto across = [&](Vec3f place) { return targets.per_area(place, {0, 0, 1}, 0); };
  EXPECT_GT(across({0.5f, 0.09f, 0}), 0);
  EXPECT_GT(across({-0.5f, 0.19f, 0}), 0);
  EXPECT_EQ(across({0.5f, 0.12f, 0}), 0);
  EXPECT_EQ(across({0, 0, 0}), 0);
}

// Of all directions, from without and within a target, from a surface that sees it and one that does not.
TEST(LightTargets, DensitiesSumToOne) {
  SceneMaker scene = room();
  scene.shape(scenedesc::SphereDesc{}, ball({0.5f, 0, 0.5f}, 0.2), scene.glass(1.5f));
  scene.shape(scenedesc::SphereDesc{}, ball({-0.5f, 0, 0.5f}, 0.2), scene.glass(1.5f));
  const world::World world = scene.build();
  const LightTargets targets(world, {0, 0, -0.9f});
  struct Case {
    Vec3f place, normal;
  };
  for (const Case& at : {Case{{0, 0, -0.5f}, {0, 0, 0}}, Case{{0.5f, 0, 0.45f}, {0, 0, 0}},
                         Case{{0, 0.9f, 0.5f}, {0, -1, 0}}, Case{{0, 0.9f, 0.5f}, {0, 1, 0}}}) {
    test::RunningMean sum;
    Rng random(3, Stage::test, 0, 0);
    for (int k = 0; k < 200000; ++k) {
      const Vec3f w = warp_sphere(random.next_2d());
      sum.add(static_cast<double>(4 * kPi * targets.per_solid_angle(at.place, at.normal, w, 1 / (4 * kPi))));
    }
    EXPECT_NEAR(sum.mean(), 1, test::normal_quantile(1e-4) * sum.standard_error());
    EXPECT_LT(sum.standard_error(), 0.02);
    for (std::size_t target = 0; target < targets.size(); ++target)
      for (int k = 0; k < 100; ++k) {
        const auto w = targets.direction_to(target, at.place, at.normal, random.next_2d());
        if (w) {
          EXPECT_GT(targets.per_solid_angle(at.place, at.normal, *w, 0), 0);
        }
      }
  }
}

// Le of a lamp is the flux of its starts, over their density: both say how light is spread over places and
// directions.
class Starts : public testing::TestWithParam<bool> {};

TEST_P(Starts, HaveTheDensitiesThatBelongToTheirFlux) {
  SceneMaker scene = gloss();
  const world::World world = scene.build();
  const EmissionSampler starts(world, GetParam() ? LightTargets(world, {0, 0, -1}) : LightTargets());
  int near = 0, far = 0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    SampleStream random(1, Stage::test, 0, k);
    const auto start = starts.sample(random);
    if (!start) continue;  // aimed below its horizon
    const float density =
        starts.density(start->emitter, start->triangle, start->ray.origin, -start->ray.direction);
    const bool sky = start->emitter == world.environment();
    EXPECT_NEAR((start->flux * density).r, sky ? 0.5f : 20.0f, 1e-3f * (sky ? 0.5f : 20.0f));
    ++(sky ? far : near);
  }
  EXPECT_GT(near, 5);
  EXPECT_GT(far, 5);
}
INSTANTIATE_TEST_SUITE_P(EmissionSampler, Starts, testing::Bool());

}  // namespace
}  // namespace lumirank::pathtrace
