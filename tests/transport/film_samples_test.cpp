#include "transport/rows/film_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/parallel.h"
#include "support/scenes.h"
#include "transport/rows/receiver_finder.h"

namespace lumirank::transport {
namespace {

using test::SceneMaker;

ReceiverSettings film_settings(int spp, int film_samples) {
  ReceiverSettings s;
  s.spp = spp, s.film_samples = film_samples;
  return s;
}

// A floor of 8 × 8 pixels, and over it poles that are a tenth of a pixel wide.
world::World poles() {
  SceneMaker scene;
  scene.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, scene.diffuse({0.2f, 0.4f, 0.6f}));
  const int white = scene.diffuse({0.9f, 0.9f, 0.9f});
  for (int k = 0; k < 8; ++k)
    scene.rectangle({-0.875f + 0.25f * static_cast<float>(k), 0, 0.5f}, {0.0125f, 0, 0}, {0, 1, 0}, white);
  return scene.build();
}
world::Camera above() { return world::Camera(test::orthographic({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 1, 8, 8)); }

TEST(FilmSamples, AreTheSameWheneverAskedFor) {
  const auto world = poles();
  const auto camera = above();
  FilmEye eye(world, camera, film_settings(4, 16));
  eye.begin({3, 2});
  const FilmSample fifth = eye.trace(5, nullptr);
  ASSERT_EQ(eye.vertices().size(), 1u);
  const EyeVertex there = eye.vertices()[0];
  eye.begin({4, 2});
  eye.trace(0, nullptr);
  eye.begin({3, 2});
  EXPECT_EQ(eye.trace(5, nullptr).film, fifth.film);
  EXPECT_EQ(eye.vertices()[0].position, there.position);
  EXPECT_EQ(eye.vertices()[0].id, there.id);
  EXPECT_EQ(static_cast<int>(fifth.film.x), 3);
  EXPECT_EQ(static_cast<int>(fifth.film.y), 2);
  EXPECT_NEAR(eye.footprint(there), 0.25f, 1e-5f);  // of 8 pixels over a width of 2
}

// The part of any number of samples that lies beyond an edge is nearly the pixel's. That of random ones is
// 1.8 (seven) and 2.5 times (nineteen) as far off.
TEST(FilmSamples, FirstOnesOfTheSequenceAreEvenlySpread) {
  const auto world = poles();
  const auto camera = above();
  for (const int count : {7, 19}) {
    double squares = 0, of_random = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      ReceiverSettings settings = film_settings(1, 0);
      settings.seed = seed;
      FilmEye eye(world, camera, settings);
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
          eye.begin({x, y});
          for (const double slope : {-0.7, 0.0, 0.4}) {
            const auto beyond = [&](Vec2f film) {
              return static_cast<double>(film.y) - y - 0.5 > slope * (static_cast<double>(film.x) - x - 0.5);
            };
            int found = 0;
            for (int k = 0; k < count; ++k)
              found += beyond(eye.trace_in_sequence(static_cast<std::uint64_t>(k)).film);
            squares += std::pow(static_cast<double>(found) / count - 0.5, 2);
            of_random += 0.25 / count;
          }
        }
    }
    EXPECT_LT(std::sqrt(squares), 0.65 * std::sqrt(of_random)) << count;
  }
}

// What no receiver sees gets one of its own, and only that; the others stay as they are without film samples.
TEST(FilmSamples, PlacesWithoutReceiversGetThem) {
  const auto world = poles();
  const auto camera = above();
  const Receivers plain = trace_receivers(world, camera, film_settings(1, 0));
  const Receivers r = trace_receivers(world, camera, film_settings(1, 64));
  EXPECT_TRUE(plain.surface.empty());
  EXPECT_EQ(plain.added, 0u);
  ASSERT_GT(r.added, 10u);
  EXPECT_EQ(r.size(), plain.size() + r.added);
  EXPECT_EQ(r.grid_samples(), plain.samples());
  std::map<std::uint64_t, std::size_t> by_id;
  for (std::size_t i = 0; i < plain.size(); ++i) by_id[plain.id[i]] = i;
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (r.sample[i] < r.grid_samples()) {
      ASSERT_TRUE(by_id.contains(r.id[i]));
      const std::size_t k = by_id[r.id[i]];
      EXPECT_EQ(r.position[i], plain.position[k]);
      EXPECT_EQ(r.weight[i], plain.weight[k]);
      EXPECT_EQ(r.sample[i], plain.sample[k]);
      by_id.erase(r.id[i]);
    } else {
      // Each of the poles covers a tenth of its pixels, so its receiver is worth a tenth of a pixel.
      EXPECT_EQ(r.albedo[i], Rgb(0.9f, 0.9f, 0.9f));
      EXPECT_NEAR(r.weight[i].g, 0.1f, 0.06f);
      EXPECT_EQ(r.emission[r.sample[i]], Rgb(0));
    }
  }
  EXPECT_TRUE(by_id.empty());
  const ReceiverFinder finder(r, {0, 0});
  FilmEye eye(world, camera, film_settings(1, 64));
  std::vector<ReceiverFinder::Near> near;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      eye.begin({x, y});
      for (int k = 0; k < 64; ++k) {
        const FilmSample s = eye.trace(k, nullptr);
        for (const EyeVertex& v : eye.vertices()) {
          EXPECT_LE(finder.find({x, y}, s.film, v, eye.footprint(v), near), FilmFit::neighbors);
          for (const auto& n : near) {
            EXPECT_EQ(r.surface[n.receiver], v.surface);
            EXPECT_NEAR(r.position[n.receiver].z, v.position.z, 1e-5f);
          }
        }
      }
    }
}

TEST(FilmSamples, TheSameReceiversWithAnyNumberOfThreads) {
  const auto world = poles();
  const auto camera = above();
  Receivers one, three;
  with_threads(1, [&] { one = trace_receivers(world, camera, film_settings(2, 16)); });
  with_threads(3, [&] { three = trace_receivers(world, camera, film_settings(2, 16)); });
  EXPECT_EQ(one.id, three.id);
  EXPECT_EQ(one.position, three.position);
  EXPECT_EQ(one.weight, three.weight);
  EXPECT_EQ(one.film, three.film);
}

// Where there is no better one, light comes from other receivers, divided by their albedo: none is lost.
TEST(FilmSamples, RatiosOfSumsKeepTheLight) {
  const auto world = poles();
  const auto camera = above();
  const Receivers r = trace_receivers(world, camera, film_settings(4, 16));
  const ReceiverFinder finder(r, {0, 0});
  std::vector<Rgb> light(r.size());
  for (std::size_t i = 0; i < r.size(); ++i) light[i] = r.albedo[i] * 3;  // as if by one irradiance
  FilmEye eye(world, camera, film_settings(4, 16));
  eye.begin({2, 2});
  std::vector<ReceiverFinder::Near> near;
  for (int k = 0; k < 16; ++k) {
    const FilmSample s = eye.trace(k, nullptr);
    EyeVertex v = eye.vertices().at(0);
    for (const bool unknown : {false, true}) {
      if (unknown) v.surface ^= 1;
      const FilmFit fit = finder.find({2, 2}, s.film, v, eye.footprint(v), near);
      EXPECT_EQ(fit == FilmFit::any, unknown);
      const Rgb value = finder.light(v, near, light);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], 3 * v.albedo[c], 1e-5f);
    }
  }
}

}  // namespace
}  // namespace lumirank::transport
