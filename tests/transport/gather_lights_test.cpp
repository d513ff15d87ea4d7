// Lights on gather samples: the flux that they hold in closed form, and that they are the same lights at
// every moment.
#include "transport/lights/gather_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/parallel.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/lights/virtual_lights.h"

namespace lumirank::transport {
namespace {

using test::SceneMaker;

LightSettings gather_settings(std::uint64_t seed, std::size_t count) {
  LightSettings s;
  s.seed = seed, s.count = count;
  s.on_gather_samples = true;
  return s;
}

SceneMaker white_box(float reflectance) {
  SceneMaker scene;
  scene.box_inside(1, scene.diffuse(Rgb(reflectance)));
  scene.point_light({0.2f, -0.1f, 0.3f}, Rgb(1));
  return scene;
}

// Incident flux, first channel, of lights that `counts` takes.
template <typename Counts>
double flux_of(const VirtualLights& lights, const Counts& counts) {
  double sum = 0;
  for (std::size_t j = 0; j < lights.size(); ++j)
    if (lights.kind[j] == LightKind::surface && counts(j)) sum += lights.power[j].r;
  return sum;
}

// The lamp's 4π reach the walls, and of every bounce a part of 0.6 goes on: exact in the mean, whatever is
// shared out among samples. Light that bounced twice or more is one light per sample, so it is one sum.
TEST(GatherLights, HoldTheFluxOfAClosedBox) {
  constexpr int kSeeds = 8;
  const auto world = white_box(0.6f).build();
  std::vector<double> direct, bounced;
  for (int seed = 0; seed < kSeeds; ++seed) {
    auto settings = gather_settings(static_cast<std::uint64_t>(seed), 2000);
    settings.max_depth = 6;  // 4 depths of surface lights
    const VirtualLights lights = trace_virtual_lights(world, settings);
    EXPECT_NEAR(static_cast<double>(lights.size()), 2000, 100);
    direct.push_back(flux_of(lights, [&](std::size_t j) { return lights.depth[j] == 1; }));
    bounced.push_back(flux_of(lights, [&](std::size_t j) { return lights.depth[j] > 1; }));
  }
  const auto expect = [&](const std::vector<double>& values, double expected, const char* what) {
    const auto m = test::mean_of(values);
    EXPECT_NEAR(m.mean, expected,
                test::student_quantile(1e-4, 2, kSeeds - 1) * m.standard_error + 1e-4 * expected)
        << what;
    EXPECT_LT(m.standard_error, 0.02 * expected) << what;
  };
  expect(direct, 4 * kPi, "depth 1");
  expect(bounced, 4 * kPi * (0.6 + 0.36 + 0.216), "depths 2 to 4");
}

TEST(GatherLights, AreTheSameOnAnyNumberOfThreads) {
  const auto world = white_box(0.5f).build();
  std::vector<VirtualLights> made(2);
  for (const int threads : {1, 3})
    with_threads(threads,
                 [&] { made[threads == 1 ? 0 : 1] = trace_virtual_lights(world, gather_settings(4, 1500)); });
  EXPECT_EQ(made[0].id, made[1].id);
  EXPECT_EQ(made[0].power, made[1].power);
  EXPECT_EQ(made[0].incoming, made[1].incoming);
}

// A box of lambertian walls with a table in it, `x` to the side.
world::World room_with_table(float x) {
  SceneMaker scene = white_box(0.5f);
  scene.rectangle({x, 0, -0.5f}, {0.3f, 0, 0}, {0, 0.3f, 0}, scene.diffuse(Rgb(0.7f, 0.2f, 0.1f)));
  return scene.build();
}

struct Frames {
  std::vector<VirtualLights> lights;
  GatherPlan plan;
};
// With the plan that the moments share, and the guide of the first one.
Frames frames_of(const std::vector<const world::World*>& worlds, std::size_t count) {
  LightSettings settings = gather_settings(7, count);
  Frames frames;
  std::vector<std::shared_ptr<const LightSurvey>> surveys;
  std::vector<const LightSurvey*> told;
  for (const world::World* world : worlds) surveys.push_back(survey_lights(*world, settings));
  for (const auto& s : surveys) told.push_back(s.get());
  frames.plan = plan_gather(worlds, told, settings);
  settings.gather = &frames.plan;
  settings.survey = told[0];
  for (const world::World* world : worlds) frames.lights.push_back(trace_virtual_lights(*world, settings));
  return frames;
}

TEST(GatherLights, OfAStillSceneAreTheSameToTheBit) {
  const auto a = room_with_table(0), b = room_with_table(0);
  const Frames frames = frames_of({&a, &b}, 2000);
  EXPECT_EQ(frames.lights[0].id, frames.lights[1].id);
  EXPECT_EQ(frames.lights[0].position, frames.lights[1].position);
  EXPECT_EQ(frames.lights[0].power, frames.lights[1].power);
  EXPECT_EQ(frames.lights[0].incoming, frames.lights[1].incoming);
}

// Samples are tied to their triangles: on the table they move by as much as it does; on the walls they stay,
// and direct light of a point, where the table does not take it away, stays the same to the bit.
TEST(GatherLights, MoveWithTheirTriangles) {
  const float shift = 0.25f;
  const auto a = room_with_table(-shift / 2), b = room_with_table(shift / 2);
  const Frames frames = frames_of({&a, &b}, 3000);
  std::map<std::uint64_t, std::size_t> later;
  for (std::size_t j = 0; j < frames.lights[1].size(); ++j) later[frames.lights[1].id[j]] = j;
  const VirtualLights &first = frames.lights[0], &second = frames.lights[1];
  std::size_t on_table = 0, on_walls = 0, the_same = 0, direct = 0, missing = 0;
  for (std::size_t j = 0; j < first.size(); ++j) {
    if (first.kind[j] != LightKind::surface) continue;
    const auto found = later.find(first.id[j]);
    if (found == later.end()) {
      ++missing;
      continue;
    }
    const std::size_t k = found->second;
    const Vec3f moved = second.position[k] - first.position[j];
    if (first.albedo[j].r > 0.6f) {
      ++on_table;
      EXPECT_NEAR(moved.x, shift, 1e-5f);
    } else {
      ++on_walls;
      EXPECT_EQ(moved.x, 0);
      if (first.depth[j] == 1) ++direct, the_same += first.power[j] == second.power[k];
    }
    EXPECT_NEAR(moved.y, 0, 1e-5f);
    EXPECT_NEAR(moved.z, 0, 1e-5f);
    EXPECT_EQ(first.albedo[j], second.albedo[k]);
  }
  EXPECT_GT(on_table, 20u);
  EXPECT_GT(on_walls, 1000u);
  EXPECT_EQ(the_same, direct);
  EXPECT_GT(missing, 0u);  // what its shadow comes to
  EXPECT_LT(static_cast<double>(missing), 0.2 * static_cast<double>(first.size()));
}

// A closed cupboard stands on the floor: beneath and in it no sample takes light that arrives beside it,
// where it would be lost.
TEST(GatherLights, KeepLightOutOfWhatIsClosed) {
  SceneMaker scene = white_box(0.7f);
  const int white = scene.diffuse(Rgb(0.7f));
  scene.shape(scenedesc::CubeDesc{}, Transform::translate(0, 0, -0.7f) * Transform::scale(0.3f, 0.3f, 0.3f),
              white);
  const auto world = scene.build();
  const VirtualLights lights = trace_virtual_lights(world, gather_settings(5, 3000));
  std::size_t under = 0, beside = 0;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (lights.kind[j] != LightKind::surface) continue;
    const Vec3f p = lights.position[j];
    const bool inside = std::abs(p.x) < 0.299f && std::abs(p.y) < 0.299f && p.z < -0.401f;
    (inside ? under : beside) += 1;
  }
  EXPECT_EQ(under, 0u);
  EXPECT_GT(beside, 2000u);
}

// Both faces of a wall without thickness have lights of their own: the lit one's bounces stay on its side.
TEST(GatherLights, StayOnTheirSideOfAThinWall) {
  SceneMaker scene;
  const int white = scene.diffuse(Rgb(0.7f));
  scene.box_inside(1, white);
  scenedesc::TwoSidedDesc both;
  both.front = both.back = white;
  scene.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, scene.bsdf(both));  // from wall to wall
  scene.point_light({0.1f, 0.2f, 0.5f}, Rgb(1));
  const auto world = scene.build();
  const VirtualLights lights = trace_virtual_lights(world, gather_settings(6, 2000));
  std::size_t above = 0;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (lights.kind[j] != LightKind::surface) continue;
    const bool dark = lights.position[j].z < -0.01f ||
                      (std::abs(lights.position[j].z) < 0.01f && lights.normal[j].z < -0.5f);
    EXPECT_FALSE(dark) << "light " << j << " at z = " << lights.position[j].z;
    above += !dark;
  }
  EXPECT_GT(above, 1500u);
}

// A triangle that a moment lacks, or that has no area there, leaves no light; the plan knows it all the same.
TEST(GatherLights, OfWhatIsNotThereAreLeftOut) {
  const auto with = room_with_table(0), without = white_box(0.5f).build();
  const Frames frames = frames_of({&without, &with}, 3000);
  const auto on_table = [](const VirtualLights& lights) {
    std::size_t n = 0;
    for (std::size_t j = 0; j < lights.size(); ++j)
      n += lights.kind[j] == LightKind::surface && lights.albedo[j].r > 0.6f;
    return n;
  };
  EXPECT_EQ(on_table(frames.lights[0]), 0u);
  EXPECT_GT(on_table(frames.lights[1]), 20u);
}

// A floor of brushed metal beneath two lamps.
VirtualLights lights_of_metal_floor(Vec3f lamp, Vec3f other, float least_roughness) {
  SceneMaker scene;
  scenedesc::ConductorDesc metal;
  metal.alpha_u.value = metal.alpha_v.value = 0.1f;
  scene.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, scene.bsdf(metal));
  scene.point_light(lamp, Rgb(1));
  scene.point_light(other, Rgb(1));
  const auto world = scene.build();
  auto settings = gather_settings(3, 500);
  settings.lobes.least_roughness = least_roughness;
  return trace_virtual_lights(world, settings);
}

// By octants of space: lamps on either side of a sample leave a light each, towards that very lamp.
TEST(GatherLights, OfWhatShinesAreKeptApartByDirection) {
  const Vec3f lamps[] = {{2, 2, 1}, {-2, 2, 1}};
  const VirtualLights lights = lights_of_metal_floor(lamps[0], lamps[1], 0.3f);
  std::map<std::pair<float, float>, std::vector<std::size_t>> at;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (lights.kind[j] != LightKind::surface) continue;
    const Vec3f p = lights.position[j], lamp = lamps[lights.incoming[j].x > 0 ? 0 : 1];
    EXPECT_GT(dot(lights.incoming[j], normalize(lamp - p)), 1 - 1e-5f);
    at[{p.x, p.y}].push_back(j);
  }
  std::size_t both = 0;
  for (const auto& [place, here] : at) {
    EXPECT_LE(here.size(), 2u);
    both += here.size() == 2;
  }
  EXPECT_GT(static_cast<double>(both), 0.9 * static_cast<double>(at.size()));
  EXPECT_GT(at.size(), 150u);
}

// Lamps in one octant: the mean direction, between theirs; of lobes as they are one of the two, so that what
// is mirrored is right in the mean.
TEST(GatherLights, OfWhatShinesHaveTheMeanDirectionOfAnOctantWhereLobesAreWidened) {
  const Vec3f lamps[] = {{4, 2, 2}, {2, 4, 2}};
  for (const float least_roughness : {0.0f, 0.3f}) {
    const VirtualLights lights = lights_of_metal_floor(lamps[0], lamps[1], least_roughness);
    std::size_t between = 0, towards_one = 0;
    for (std::size_t j = 0; j < lights.size(); ++j) {
      if (lights.kind[j] != LightKind::surface) continue;
      const Vec3f first = normalize(lamps[0] - lights.position[j]), d = lights.incoming[j];
      const Vec3f second = normalize(lamps[1] - lights.position[j]);
      const float apart = dot(first, second);
      towards_one += std::max(dot(d, first), dot(d, second)) > 1 - 1e-5f;
      between += std::min(dot(d, first), dot(d, second)) > apart + 1e-3f;
      EXPECT_NEAR(dot(d, cross(first, second)), 0, 1e-5f);  // in their plane
    }
    if (least_roughness > 0)
      EXPECT_GT(between, 9 * towards_one);
    else
      EXPECT_EQ(between, 0u);
    EXPECT_GT(between + towards_one, 150u);
  }
}

TEST(GatherSamples, StandForAllOfTheArea) {
  const auto world = room_with_table(0);
  const GatherMoment moment{&world, nullptr};
  std::vector<double> areas;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const GatherSamples samples = place_gather_samples({&moment, 1}, seed, 500);
    EXPECT_NEAR(static_cast<double>(samples.samples.size()), 500, 2);
    double sum = 0;
    for (const GatherSample& s : samples.samples) sum += s.part * 0.5 * (s.shape < 6 ? 4 : 0.36);
    areas.push_back(sum);
  }
  const auto m = test::mean_of(areas);
  EXPECT_NEAR(m.mean, 6 * 4 + 0.36, 0.01 * 24);
}

}  // namespace
}  // namespace lumirank::transport
