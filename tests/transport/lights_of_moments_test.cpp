// Lights that stay while smoke moves: each moment's light is what it would be by itself.
#include "transport/lights/lights_of_moments.h"

#include <gtest/gtest.h>

#include "media/tracking.h"
#include "support/statistics.h"
#include "transport/foggy_room.h"

namespace lumirank::transport {
namespace {

using test::mean_of;
using test::normal_quantile;

// The room at three moments: fog and a ball of smoke, twice as thick and of other places, and none of the
// smoke.
std::vector<world::World> moments() {
  std::vector<world::World> out;
  out.reserve(3);
  for (int k = 0; k < 3; ++k) {
    scenedesc::SceneDesc desc = foggy_room();
    desc.media[0].extinction.value *= 1 + 0.5f * static_cast<float>(k);
    if (k > 0) {
      auto grid = std::make_shared<scenedesc::GridData>(
          *std::get<std::shared_ptr<const scenedesc::GridData>>(desc.volumes[0].kind));
      std::reverse(grid->values.begin(), grid->values.end());
      for (float& v : grid->values) v = k == 1 ? 2 * v : 0;
      desc.volumes[0].kind = std::shared_ptr<const scenedesc::GridData>(grid);
    }
    out.push_back(testing::build_world(desc, out.empty() ? nullptr : &out.front()));
  }
  return out;
}

std::vector<const world::World*> pointers(const std::vector<world::World>& worlds) {
  std::vector<const world::World*> out;
  for (const world::World& world : worlds) out.push_back(&world);
  return out;
}

// What lights bring, by numbers that the expectation of each is asked of: what rays of the first and of later
// flights scatter in the fog and in the smoke, and what lands on surfaces.
std::array<double, 5> brought(const world::World& world, const LightsInMedia& lights) {
  std::array<double, 5> sums{};
  const RayLights& rays = lights.rays;
  for (std::size_t j = 0; j < rays.size(); ++j) {
    const media::Medium& medium = world.media()[static_cast<std::size_t>(rays.medium[j])];
    constexpr int kPlaces = 8;
    Rgb scattered{0};
    Rng rng(1, Stage::test, j);
    const auto random = [&rng] { return rng.next_float(); };
    for (int k = 0; k < kPlaces; ++k) {
      const float t = rays.length[j] * (static_cast<float>(k) + 0.5f) / kPlaces;
      scattered += media::transmittance(medium, rays.origin[j], rays.direction[j], t, random) *
                   medium.at(rays.origin[j] + rays.direction[j] * t).scattering * (rays.length[j] / kPlaces);
    }
    const std::size_t which = (rays.medium[j] == 0 ? 0 : 2) + (rays.depth[j] > 1 ? 1 : 0);
    sums[which] += static_cast<double>(luminance(scattered * rays.power[j]));
  }
  for (std::size_t j = 0; j < lights.points.size(); ++j)
    if (lights.points.kind[j] == LightKind::surface)
      sums[4] += static_cast<double>(luminance(lights.points.power[j]));
  return sums;
}

TEST(LightsOfMoments, HaveEachMomentsOwnExpectation) {
  const std::vector<world::World> worlds = moments();
  constexpr std::size_t kSeeds = 60;
  MediaLightSettings settings;
  settings.count = 3000, settings.eye_medium = 0, settings.direct = false;
  std::vector<std::vector<std::vector<double>>> alone(3, std::vector<std::vector<double>>(5)),
      together = alone;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    settings.seed = seed;
    const auto lights = trace_lights_of_moments(pointers(worlds), settings);
    settings.seed = 1000 + seed;
    for (std::size_t k = 0; k < worlds.size(); ++k) {
      const auto a = brought(worlds[k], lights[k]),
                 b = brought(worlds[k], trace_lights_in_media(worlds[k], settings));
      for (std::size_t n = 0; n < a.size(); ++n) together[k][n].push_back(a[n]), alone[k][n].push_back(b[n]);
    }
  }
  for (std::size_t k = 0; k < worlds.size(); ++k)
    for (std::size_t n = 0; n < 5; ++n) {
      const auto a = mean_of(together[k][n]), b = mean_of(alone[k][n]);
      if (k == 2 && (n == 2 || n == 3)) {
        EXPECT_EQ(a.mean, 0) << "there is no smoke then";
        continue;
      }
      // Two in a thousand for what steps of half a number of the grids miss.
      EXPECT_NEAR(a.mean, b.mean,
                  normal_quantile(1e-4, 13) * std::hypot(a.standard_error, b.standard_error) + 2e-3 * b.mean)
          << "moment " << k << ", number " << n;
      EXPECT_LT(a.standard_error, 0.1 * b.mean) << "the test can tell";
    }
}

TEST(LightsOfMoments, StayWhereTheyAre) {
  const std::vector<world::World> worlds = moments();
  MediaLightSettings settings;
  settings.count = 500, settings.eye_medium = 0;
  const auto lights = trace_lights_of_moments(pointers(worlds), settings);
  ASSERT_EQ(lights.size(), 3u);
  std::size_t changed = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_EQ(lights[k].rays.id, lights[0].rays.id);
    EXPECT_EQ(lights[k].points.id, lights[0].points.id);
    ASSERT_EQ(lights[k].rays.size(), lights[0].rays.size());
    for (std::size_t j = 0; j < lights[k].rays.size(); ++j) {
      EXPECT_EQ(lights[k].rays.origin[j], lights[0].rays.origin[j]);
      EXPECT_EQ(lights[k].rays.length[j], lights[0].rays.length[j]);
      changed += lights[k].rays.power[j] != lights[0].rays.power[j];
    }
  }
  EXPECT_GT(changed, lights[0].rays.size() / 4);
  // Moments that are alike have lights that are.
  const std::vector<const world::World*> same{&worlds[1], &worlds[1]};
  const auto still = trace_lights_of_moments(same, settings);
  EXPECT_EQ(still[0].rays.power, still[1].rays.power);
  EXPECT_EQ(still[0].points.power, still[1].points.power);
}

TEST(LightsOfMoments, NeedSurfacesAndEmittersThatStandStill) {
  const std::vector<world::World> worlds = moments();
  EXPECT_TRUE(only_media_differ(pointers(worlds)));
  scenedesc::SceneDesc moved = foggy_room(), switched = foggy_room();
  moved.shapes.back().to_world = Transform::translate(0.1, 0, 0) * moved.shapes.back().to_world;
  std::get<scenedesc::PointLightDesc>(switched.emitters.back().kind).position = Vec3d{0, 1, 0};
  const world::World other = testing::build_world(moved, &worlds[0]),
                     lit = testing::build_world(switched, &worlds[0]);
  const std::vector<const world::World*> first{&worlds[0], &other}, second{&worlds[0], &lit};
  EXPECT_FALSE(only_media_differ(first));
  EXPECT_FALSE(only_media_differ(second));
}

}  // namespace
}  // namespace lumirank::transport
