// Light paths through media: the same picture in the mean as without them, and light in fog behind glass with
// less noise.
#include <gtest/gtest.h>

#include <memory>

#include "media/forced_collision.h"
#include "media/tracking.h"
#include "pathtrace/few_ways.h"

namespace lumirank::pathtrace {
namespace {

using test::SceneMaker;

// Of the room, in lumps.
int add_smoke_grid(SceneMaker& scene, double half = 1) {
  auto grid = std::make_shared<scenedesc::GridData>();
  grid->size = {6, 6, 6};
  for (int k = 0; k < 6 * 6 * 6; ++k) grid->values.push_back(k % 5 == 0 ? 3.0f : (k % 3 == 0 ? 0.5f : 0.0f));
  scenedesc::VolumeDesc volume;
  volume.to_world =
      Transform::scale(half, half, half) * Transform::translate(-1, -1, -1) * Transform::scale(2, 2, 2);
  volume.kind = std::shared_ptr<const scenedesc::GridData>(grid);
  scene.desc.volumes.push_back(volume);
  return static_cast<int>(scene.desc.volumes.size()) - 1;
}

SceneMaker bulb_in_fog(Rgb extinction, Rgb g) {
  SceneMaker scene = room();
  add_ball_lamp(scene, {0.3f, 0.4f, 0.2f}, 0.18, 20);
  scene.shape(scenedesc::SphereDesc{}, ball({0.3f, 0.4f, 0.2f}, 0.25), scene.glass(1.5f));
  fill(scene, fog(extinction, {0.9f, 0.8f, 0.7f}, g));
  return scene;
}

SceneMaker bulb_in_smoke() {
  SceneMaker scene = bulb_in_fog(Rgb(1), Rgb(-0.3f));
  scene.desc.media[0].extinction = {{0.5f, 1, 1.5f}, add_smoke_grid(scene)};
  return scene;
}

// A cube of fog without the camera, a ball of glass in it that keeps the fog out, a sun of 27 degrees.
SceneMaker block_of_fog_in_the_sun() {
  SceneMaker scene;
  scene.desc.media.push_back(fog({1.2f, 1, 0.8f}, Rgb(0.95f), Rgb(0.4f)));
  scene.rectangle({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, scene.diffuse({0.6f, 0.5f, 0.4f}));
  scene
      .shape(scenedesc::CubeDesc{}, Transform::translate(0, 0.6, 0) * Transform::scale(0.7, 0.59, 0.7),
             scene.bsdf(scenedesc::NullBsdfDesc{}))
      .media = {true, 0, scenedesc::kNone};
  scene.shape(scenedesc::SphereDesc{}, ball({0, 0.7f, 0}, 0.25), scene.glass(1.5f)).media = {
      true, scenedesc::kNone, 0};
  scenedesc::SunSkyDesc sun;
  sun.sky = false, sun.sun_radius_scale = 50;
  sun.sun_direction = Vec3f{-0.5f, 0.8f, 0.2f};
  scene.light(sun);
  scene.desc.sensors.push_back(
      test::sensor({0.2f, 1.2f, -2.5f}, {0.15f, 0.5f, 0}, {0, 1, 0}, 40, kWidth, kHeight));
  return scene;
}

// A lamp that eye paths find in every way that they have: from a place drawn for it, from where they collide,
// by chance.
SceneMaker open_lamp_in_fog() {
  SceneMaker scene = room();
  add_ball_lamp(scene, {0.3f, 0.2f, 0.2f}, 0.1, 20);
  fill(scene, fog({1.5f, 1.2f, 0.9f}, Rgb(0.95f), Rgb(0.3f)));
  return scene;
}

// The sky's light has come through smoke that reaches beyond the scene.
SceneMaker sky_through_smoke() {
  SceneMaker scene;
  scene.rectangle({0, -1, 0}, {1, 0, 0}, {0, 0, -1}, scene.diffuse(Rgb(0.8f)));
  scene.rectangle({0, 0, 1}, {1, 0, 0}, {0, -1, 0}, scene.diffuse(Rgb(0.8f)));
  scene.light(scenedesc::ConstantEnvironmentDesc{Rgb(1)});
  scene.desc.sensors.push_back(test::sensor({0.3f, 0.3f, -1}, {0, -0.5f, 1}, {0, 1, 0}, 60, kWidth, kHeight));
  fill(scene, fog(Rgb(0.3f), Rgb(0.5f), Rgb(0)));
  scene.desc.media[0].extinction.volume = add_smoke_grid(scene, 6);
  return scene;
}

// A spot from above on a lit floor, and a sky that comes in through smoke in front.
SceneMaker spot_and_sky_in_smoke() {
  SceneMaker scene;
  const int white = scene.diffuse(Rgb(0.6f));
  scene.rectangle({0, -1, 0}, {1, 0, 0}, {0, 0, -1}, white);
  scene.rectangle({0, 0, 1}, {1, 0, 0}, {0, -1, 0}, white);
  scene.light(scenedesc::ConstantEnvironmentDesc{Rgb(0.3f)});
  scenedesc::SpotLightDesc spot;
  spot.to_world = Transform::look_at({0, 0.9, 0.2}, {0.2, -1, 0.3}, {1, 0, 0});
  spot.intensity = Rgb(2);
  spot.cutoff_angle = 40, spot.beam_width = 20;
  scene.light(spot);
  scene.desc.sensors.push_back(
      test::sensor({0.3f, 0.3f, -2.5f}, {0, -0.2f, 1}, {0, 1, 0}, 45, kWidth, kHeight));
  fill(scene, fog(Rgb(1), Rgb(0.9f), Rgb(0.3f)));
  scene.desc.media[0].extinction.volume = add_smoke_grid(scene);
  return scene;
}

TEST(LightTracerInMedia, ABulbInGlassIsTheSameWithHalfTheVariance) {
  for (const Rgb g : {Rgb(0), Rgb(0.6f)}) {
    const SceneMaker scene = bulb_in_fog({0.5f, 0.6f, 0.8f}, g);
    const auto alone = means(scene, Paths::all, 0, kPicturesOfEach),
               both = means(scene, Paths::all, 1, kPicturesOfEach);
    expect_same(alone, both);
    EXPECT_LT(both.variance(), alone.variance() / 2);
  }
}

TEST(LightTracerInMedia, ChannelsMayBeAsDifferentAsTheyLike) {
  const SceneMaker scene = bulb_in_fog({0, 0.5f, 6}, {0.8f, 0, -0.5f});
  expect_same(means(scene, Paths::all, 0, kPicturesOfEach), means(scene, Paths::all, 1, kPicturesOfEach),
              0.1);
}

TEST(LightTracerInMedia, SmokeIsTheSame) {
  expect_same(means(bulb_in_smoke(), Paths::all, 0, kPicturesOfEach),
              means(bulb_in_smoke(), Paths::all, 1, kPicturesOfEach), 0.1);
}

TEST(LightTracerInMedia, ASunIntoABlockOfFogIsTheSame) {
  for (const bool aim : {false, true})
    expect_same(means(block_of_fog_in_the_sun(), Paths::all, 0, 2 * kPicturesOfEach),
                means(block_of_fog_in_the_sun(), Paths::all, 1, 2 * kPicturesOfEach, aim), 0.1);
}

TEST(LightTracerInMedia, ASpotAndASkyInSmokeAreTheSame) {
  expect_same(means(spot_and_sky_in_smoke(), Paths::all, 0, kPicturesOfEach),
              means(spot_and_sky_in_smoke(), Paths::all, 1, kPicturesOfEach));
}

TEST(LightTracerInMedia, AnOpenLampIsTheSame) {
  expect_same(means(open_lamp_in_fog(), Paths::all, 0, kPicturesOfEach),
              means(open_lamp_in_fog(), Paths::all, 4, kPicturesOfEach));
}

TEST(LightTracerInMedia, ASkyThroughSmokeIsTheSame) {
  expect_same(means(sky_through_smoke(), Paths::all, 0, kPicturesOfEach),
              means(sky_through_smoke(), Paths::all, 4, kPicturesOfEach));
}

TEST(LightTracerInMedia, DepthIsLimitedAlike) {
  SceneMaker scene = bulb_in_fog(Rgb(0.6f), Rgb(0.3f));
  scene.desc.max_depth = 4;
  expect_same(means(scene, Paths::all, 0, 2 * kPicturesOfEach),
              means(scene, Paths::all, 1, 2 * kPicturesOfEach), 0.08);
}

// What collides at forced places, over their density, is what does not get through.
TEST(ForcedCollision, HasTheDensityOfItsPlaces) {
  SceneMaker scene = bulb_in_smoke();
  scene.desc.media.push_back(fog({0, 0.5f, 6}, Rgb(1), Rgb(0)));
  const world::World world = scene.build();
  const Vec3f from = world.units().to_world(Vec3d{-3, 0.15, 0.2}), along = normalize(Vec3f{1, 0.05f, 0.1f});
  for (const auto& medium : world.media()) {
    const auto scale = static_cast<float>(world.units().scale());
    for (const float t_max : {2.7f * scale, 4.5f * scale, kInfinity}) {
      if (!std::isfinite(t_max) && medium.homogeneous()) continue;  // endless
      test::RunningMean lost;
      Rng random(4, Stage::test, 1);
      for (int k = 0; k < 100000; ++k) {
        const float u_channel = random.next_float();
        const RayPlace place =
            media::force_collision(medium, from, along, t_max, u_channel, random.next_float());
        ASSERT_GT(place.pdf, 0);
        ASSERT_LE(place.t, t_max);
        const Rgb collides =
            medium.extinction(from + along * place.t) *
            media::transmittance(medium, from, along, place.t, [&random] { return random.next_float(); });
        lost.add(static_cast<double>(collides.g / place.pdf));
      }
      test::RunningMean through;
      for (int k = 0; k < 100000; ++k)
        through.add(static_cast<double>(
            media::transmittance(medium, from, along, t_max, [&random] { return random.next_float(); }).g));
      EXPECT_NEAR(lost.mean(), 1 - through.mean(),
                  test::normal_quantile(1e-4) * std::hypot(lost.standard_error(), through.standard_error()));
      EXPECT_LT(lost.standard_error(), 0.01);
    }
  }
}

// Far behind what light gets through nothing is drawn, and an endless medium has places nonetheless.
TEST(ForcedCollision, DrawsWhereLightGets) {
  SceneMaker scene = room();
  scene.desc.media.push_back(fog({2, 2, 2}, Rgb(1), Rgb(0)));
  const world::World world = scene.build();
  const auto& medium = world.media()[0];
  const float mean_free = 1 / medium.even_extinction().r;
  Rng random(4, Stage::test, 2);
  test::RunningMean where;
  for (int k = 0; k < 10000; ++k) {
    const RayPlace place =
        media::force_collision(medium, {0, 0, 0}, {1, 0, 0}, kInfinity, 0.5f, random.next_float());
    ASSERT_TRUE(std::isfinite(place.t));
    EXPECT_NEAR(place.pdf * mean_free, std::exp(-place.t / mean_free), 1e-3);
    where.add(static_cast<double>(place.t / mean_free));
  }
  EXPECT_NEAR(where.mean(), 1, test::normal_quantile(1e-4) * where.standard_error());
}

}  // namespace
}  // namespace lumirank::pathtrace
