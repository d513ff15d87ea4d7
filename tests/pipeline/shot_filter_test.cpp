// Frames averaged with their neighbors in time, on films made by hand of a wall that the camera faces.
#include "pipeline/shot_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/random.h"
#include "world/camera.h"
#include "world/scene_maker.h"

namespace lumirank::pipeline {
namespace {

constexpr int kFrameSide = 24;

// A camera in (x, 0, 0) that looks along z at a wall in z = 4, which fills its film. `light`, `albedo`: of a
// place (x, y) of the wall.
using OfWall = std::function<float(float, float)>;
ShotFrame frame_of(float camera_x, const OfWall& light, const OfWall& albedo = {}) {
  ShotFrame frame;
  scenedesc::SensorDesc& sensor = frame.view.sensor;
  sensor.film.width = sensor.film.height = kFrameSide;
  sensor.to_world = Transform::translate(camera_x, 0, 0);
  frame.view.width = frame.view.height = kFrameSide;
  frame.picture = image::Image(kFrameSide, kFrameSide);
  if (albedo) frame.albedo = image::Image(kFrameSide, kFrameSide);
  const world::Camera camera(sensor);
  for (int y = 0; y < kFrameSide; ++y)
    for (int x = 0; x < kFrameSide; ++x) {
      const geometry::Ray ray =
          camera.ray({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, {0.5f, 0.5f});
      const float t = (4 - ray.origin.z) / ray.direction.z;
      FilmSurface surface;
      surface.position = ray.origin + ray.direction * t;
      surface.normal = {0, 0, -1};
      surface.spacing = surface.along = 1 / std::sqrt(camera.density(ray, t));
      const float reflected = albedo ? albedo(surface.position.x, surface.position.y) : 1;
      if (albedo) frame.albedo.at(x, y) = Rgb(reflected);
      frame.picture.at(x, y) = Rgb(reflected * light(surface.position.x, surface.position.y));
      frame.surfaces.push_back(surface);
      frame.tolerance.push_back(0.2f);
    }
  return frame;
}
OfWall even(float light) {
  return [light](float, float) { return light; };
}
// The root mean square difference of pixels away from the film's edge, where neighbors show all of it.
double difference(const image::Image& a, const image::Image& b) {
  double all = 0;
  constexpr int kEdge = 6;
  for (int y = kEdge; y < kFrameSide - kEdge; ++y)
    for (int x = kEdge; x < kFrameSide - kEdge; ++x)
      all += std::pow(static_cast<double>(a.at(x, y).r - b.at(x, y).r), 2);
  return std::sqrt(all) / (kFrameSide - 2 * kEdge);
}

TEST(ShotFilter, NoiseOfStillLightIsAveraged) {
  std::deque<ShotFrame> frames;
  for (std::uint64_t k = 0; k < 7; ++k) {
    frames.push_back(frame_of(0, even(1)));
    Rng rng(1, Stage::test, k, 0);
    for (Rgb& color : frames.back().picture.pixels) color = Rgb(1 + 0.1f * (rng.next_float() - 0.5f));
  }
  const image::Image clean = frame_of(0, even(1)).picture;
  const double before = difference(frames[3].picture, clean),
               after = difference(filtered_in_time(frames, 3), clean);
  EXPECT_LT(after, before * 1.15 / std::sqrt(7.0));
  EXPECT_GT(after, before * 0.8 / std::sqrt(7.0));
  // At the end of a shot there are frames on one side alone.
  const double at_end = difference(filtered_in_time(frames, 0), clean);
  EXPECT_LT(at_end, 1.6 * after);
}

// A highlight: each pixel differs much from the next one, but nothing moves.
TEST(ShotFilter, NoiseIsAveragedBesideOtherLight) {
  const OfWall steep = [](float x, float) { return std::exp(6 * x); };
  std::deque<ShotFrame> frames;
  for (std::uint64_t k = 0; k < 7; ++k) {
    frames.push_back(frame_of(0, steep));
    Rng rng(1, Stage::test, k, 0);
    for (Rgb& color : frames.back().picture.pixels) color *= 1 + 0.1f * (rng.next_float() - 0.5f);
  }
  const image::Image clean = frame_of(0, steep).picture;
  EXPECT_LT(difference(filtered_in_time(frames, 3), clean),
            difference(frames[3].picture, clean) * 1.15 / std::sqrt(7.0));
}

TEST(ShotFilter, LightThatChangesEvenlyStays) {
  std::deque<ShotFrame> frames;
  for (int k = 0; k < 7; ++k) frames.push_back(frame_of(0, even(1 + 0.05f * static_cast<float>(k))));
  EXPECT_LT(difference(filtered_in_time(frames, 3), frames[3].picture), 1e-5);
}

// The edge of a shadow sweeps over the wall: what is lit in all frames, or in none, has nothing of it, and
// neither has what it reaches in this very frame.
TEST(ShotFilter, AShadowThatMovesLeavesNothingBehind) {
  std::deque<ShotFrame> frames;
  for (int k = 0; k < 7; ++k)
    frames.push_back(
        frame_of(0, [k](float x, float) { return x < 0.2f * static_cast<float>(k - 3) ? 0.2f : 1.0f; }));
  EXPECT_LT(difference(filtered_in_time(frames, 3), frames[3].picture), 1e-6);
}

// The camera moves, the wall's texture is of the size of pixels: where there is no noise nothing changes.
TEST(ShotFilter, TexturesStaySharpWhereTheCameraMoves) {
  std::deque<ShotFrame> frames;
  const auto texture = [](float x, float y) { return 0.5f + 0.4f * std::sin(23 * x) * std::sin(31 * y); };
  const auto light = [](float x, float y) { return 2 + 0.3f * x + 0.1f * y; };
  for (int k = 0; k < 7; ++k) frames.push_back(frame_of(0.13f * static_cast<float>(k), light, texture));
  EXPECT_LT(difference(filtered_in_time(frames, 3), frames[3].picture), 1e-3);
  // Noise goes away all the same.
  const image::Image clean = frames[3].picture;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    Rng rng(2, Stage::test, k, 0);
    for (Rgb& color : frames[k].picture.pixels) color = color * (1 + 0.1f * (rng.next_float() - 0.5f));
  }
  EXPECT_LT(difference(filtered_in_time(frames, 3), clean), 0.55 * difference(frames[3].picture, clean));
}

TEST(ShotFilter, WhatIsHiddenOrShinesIsLeftAsItIs) {
  std::deque<ShotFrame> frames;
  for (int k = 0; k < 3; ++k) frames.push_back(frame_of(0, even(1 + 0.01f * static_cast<float>(k % 2))));
  const image::Image own = frames[1].picture;
  std::deque<ShotFrame> hidden = frames;
  for (const std::size_t other : {0, 2})
    for (FilmSurface& surface : hidden[other].surfaces) surface.position.z -= 1;
  EXPECT_EQ(difference(filtered_in_time(hidden, 1), own), 0);
  std::deque<ShotFrame> turned = frames;
  for (const std::size_t other : {0, 2})
    for (FilmSurface& surface : turned[other].surfaces) surface.normal = {0, 1, 0};
  EXPECT_EQ(difference(filtered_in_time(turned, 1), own), 0);
  std::deque<ShotFrame> shining = frames;
  for (float& tolerance : shining[1].tolerance) tolerance = 0;
  EXPECT_EQ(difference(filtered_in_time(shining, 1), own), 0);
  // Nor is it light of what does not.
  shining = frames;
  for (const std::size_t other : {0, 2})
    for (float& tolerance : shining[other].tolerance) tolerance = 0;
  EXPECT_EQ(difference(filtered_in_time(shining, 1), own), 0);
  EXPECT_GT(difference(filtered_in_time(frames, 1), own), 0);
}

// A wall that fills the film slides by, and turns: its light goes with its triangles.
TEST(ShotFilter, WhatMovesTakesItsLightAlong) {
  namespace sd = test::sd;
  std::deque<ShotFrame> frames;
  for (int k = 0; k < 5; ++k) {
    auto desc = test::empty_scene();
    auto& sensor = desc.sensors[0];
    sensor.to_world = Transform::look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
    sensor.film.width = sensor.film.height = kFrameSide;
    const Transform moved = Transform::rotate(0, 0, 1, 4 * k) * Transform::translate(0.7 * k, 0, 0);
    test::add_shape(desc, sd::RectangleDesc{}, moved * Transform::scale(40, 40, 1));
    const auto world = std::make_shared<const world::World>(test::build(desc));
    const View view = make_view(desc, {});
    // Stripes across the wall, of which places in the world know nothing.
    ShotFrame frame = shot_frame(world, view, image::Image(kFrameSide, kFrameSide, Rgb(1)), {});
    for (std::size_t p = 0; p < frame.picture.pixels.size(); ++p) {
      const Vec3f on_wall = moved.inverse()->point(frame.surfaces[p].position);
      frame.picture.pixels[p] = Rgb(1 + 0.5f * std::sin(on_wall.x));
    }
    frames.push_back(std::move(frame));
  }
  const image::Image clean = frames[2].picture;
  EXPECT_LT(difference(filtered_in_time(frames, 2), clean), 0.01);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    Rng rng(3, Stage::test, k, 0);
    for (Rgb& color : frames[k].picture.pixels) color = color * (1 + 0.1f * (rng.next_float() - 0.5f));
  }
  EXPECT_LT(difference(filtered_in_time(frames, 2), clean), 0.6 * difference(frames[2].picture, clean));
  for (ShotFrame& frame : frames) frame.world = nullptr;
  EXPECT_GT(difference(filtered_in_time(frames, 2), clean), 0.8 * difference(frames[2].picture, clean));
}

}  // namespace
}  // namespace lumirank::pipeline
