// Panes that let light pass straight are glass to the eye.
#include <gtest/gtest.h>

#include "pathtrace/few_ways.h"

namespace lumirank::pathtrace {
namespace {

constexpr Rgb kHaze{0.8f, 0.6f, 0.4f};

// Before the eye: a sheet that shows its edge, and light comes through its faces and its rim.
void add_sheet(SceneMaker& scene) {
  scene.shape(scenedesc::CubeDesc{},
              Transform::translate(0.05, -0.3, -0.1) * Transform::rotate(0, 1, 0, 8) *
                  Transform::scale(0.03, 0.5, 0.5),
              scene.glass(1.5f));
}

// The sheet before walls that shine, each in a color of its own.
SceneMaker sheet_in_shining_room() {
  SceneMaker scene;
  const int dark = scene.diffuse(Rgb(0));
  scene.lamp({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {4, 3, 2}, dark);
  scene.lamp({-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 2, 3}, dark);
  scene.lamp({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {3, 1, 1}, dark);
  scene.lamp({0, -1, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 3}, dark);
  scene.desc.sensors.push_back(
      test::sensor({0.1f, 0.2f, -0.95f}, {0, -0.2f, 1}, {0, 1, 0}, 80, kWidth, kHeight));
  return scene;
}

image::Image picture(SceneMaker scene, bool straight_panes) {
  scene.straight_panes = straight_panes;
  const world::World world = scene.build();
  PathFilm film(world, world::make_view(scene.desc, {}), {});
  EXPECT_TRUE(film.add(16, {}));
  return film.result().image;
}

TEST(SeenGlass, OfAPaneIsWhatAnyGlassShows) {
  for (const bool hazy : {false, true}) {
    SceneMaker scene = sheet_in_shining_room();
    if (hazy) fill(scene, fog(kHaze, Rgb(0), Rgb(0.3f)));
    const image::Image without = picture(scene, true);
    add_sheet(scene);
    const image::Image bent = picture(scene, false);
    EXPECT_EQ(picture(scene, true).pixels, bent.pixels) << "hazy: " << hazy;
    EXPECT_NE(without.pixels, bent.pixels);
  }
}

SceneMaker room_behind_sheet() {
  SceneMaker scene = room();
  add_ball_lamp(scene, {-0.5f, 0.6f, 0.2f}, 0.1, 20);
  add_sheet(scene);
  scene.straight_panes = true;
  return scene;
}

TEST(SeenGlass, OfPanesShowsTheSameLightWithLightPaths) {
  EXPECT_EQ(room_behind_sheet().build().info().panes, 1u);
  expect_same(means(room_behind_sheet(), Paths::all, 0, kPicturesOfEach),
              means(room_behind_sheet(), Paths::all, 1, kPicturesOfEach));
}

TEST(SeenGlass, OfPanesInHazeShowsTheSameLightWithLightPaths) {
  SceneMaker scene = room();
  add_ball_lamp(scene, {-0.5f, 0.6f, 0.2f}, 0.1, 20);
  scene.shape(scenedesc::CubeDesc{}, Transform::translate(0.1, 0.1, -0.6) * Transform::scale(0.5, 0.5, 0.01),
              scene.glass(1.5f));
  scene.straight_panes = true;
  fill(scene, fog(kHaze, Rgb(0.8f), Rgb(0.3f)));
  expect_same(means(scene, Paths::all, 0, kPicturesOfEach), means(scene, Paths::all, 1, kPicturesOfEach));
}

}  // namespace
}  // namespace lumirank::pathtrace
