#include "transport/lights/virtual_lights.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/false_alarms.h"
#include "transport/rows/receivers.h"

namespace lumirank::transport {
namespace {

using test::SceneMaker;

Rgb total_power(const VirtualLights& lights, LightKind kind) {
  Rgb sum{0};
  for (std::size_t j = 0; j < lights.size(); ++j)
    if (lights.kind[j] == kind) sum += lights.power[j];
  return sum;
}

// Sum of the flux of surface lights, per depth, of the first channel.
std::map<int, double> flux_by_depth(const VirtualLights& lights) {
  std::map<int, double> sums;
  for (std::size_t j = 0; j < lights.size(); ++j)
    if (lights.kind[j] == LightKind::surface) sums[lights.depth[j]] += lights.power[j].r;
  return sums;
}

void expect_mean(const std::vector<double>& values, double expected, std::size_t tests,
                 const std::string& what) {
  const auto m = test::mean_of(values);
  const double bound = test::student_quantile(kAlpha, tests, values.size() - 1) * m.standard_error;
  // Sums of thousands of floats: rounding of 1e-5 where there is no noise at all.
  EXPECT_NEAR(m.mean, expected, bound + 1e-5 * std::abs(expected)) << what;
}

LightSettings light_settings(std::uint64_t seed, std::size_t count) {
  LightSettings s;
  s.seed = seed, s.count = count;
  return s;
}

SceneMaker furnace(float reflectance, Rgb intensity = Rgb(1)) {
  SceneMaker scene;
  scene.box_inside(1, scene.diffuse(Rgb(reflectance)));
  scene.point_light({0.2f, -0.1f, 0.3f}, intensity);
  return scene;
}

// Oriented lights carry radiance × area share: over the whole lamp Le·A, so π times their sum is its power
// π·Le·A. All triangles shine alike, so this holds without noise.
TEST(VirtualLights, AreaLampSumsToItsPower) {
  SceneMaker scene;
  scene.rectangle({0, 0, -1}, {2, 0, 0}, {0, 2, 0}, scene.diffuse(Rgb(0.5f)));
  scene.lamp({0, 0, 1}, {0, 0.5f, 0}, {0.25f, 0, 0}, {3, 2, 1}, scene.diffuse(Rgb(0)));  // 1 × 0.5, downwards
  const auto world = scene.build();
  auto settings = light_settings(1, 500);
  settings.indirect = false;
  const auto lights = trace_virtual_lights(world, settings);
  EXPECT_EQ(lights.size(), 500u);
  EXPECT_EQ(lights.direct_count, 500u);
  EXPECT_EQ(lights.paths, 0u);
  const Rgb sum = total_power(lights, LightKind::oriented);
  EXPECT_NEAR(sum.r, 3 * 0.5, 1e-4);
  EXPECT_NEAR(sum.g, 2 * 0.5, 1e-4);
  EXPECT_NEAR(sum.b, 1 * 0.5, 1e-4);
  float area = 0;
  int upper_half = 0;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    EXPECT_NEAR(lights.normal[j].z, -1, 1e-6);
    EXPECT_NEAR(lights.position[j].z, 1, 1e-6);
    EXPECT_LE(std::abs(lights.position[j].x), 0.25f + 1e-6f);
    EXPECT_LE(std::abs(lights.position[j].y), 0.5f + 1e-6f);
    EXPECT_EQ(lights.depth[j], 0);
    area += lights.area[j];
    upper_half += lights.position[j].y > 0;
  }
  EXPECT_NEAR(area, 0.5, 1e-4);
  // Stratified over the area: independent samples would have a standard deviation of √125 ≈ 11.
  EXPECT_NEAR(upper_half, 250, 11);
}

// ∫ L dω = 4π for a constant environment of radiance 1: the irradiances of all directional lights.
TEST(VirtualLights, EnvironmentSumsToItsIntegral) {
  SceneMaker scene;
  scene.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, scene.diffuse(Rgb(0.5f)));
  scene.light(scenedesc::ConstantEnvironmentDesc{Rgb(1)});
  auto settings = light_settings(1, 1000);
  settings.indirect = false;
  const auto lights = trace_virtual_lights(scene.build(), settings);
  EXPECT_EQ(lights.size(), 1000u);
  EXPECT_NEAR(total_power(lights, LightKind::directional).r, 4 * kPi, 1e-3);
  // Irradiance of a horizontal plane: ∫ cosθ dω over the upper half = π. Stratified samples: well under the
  // error of independent ones, 4π·sd(cos⁺)/√1000 = 4π·√(1/6 - 1/16)/√1000 ≈ 0.13.
  float irradiance = 0;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    EXPECT_NEAR(length(lights.normal[j]), 1, 1e-5);
    irradiance += lights.power[j].r * std::max(0.0f, -lights.normal[j].z);
    EXPECT_EQ(lights.area[j], 0);
  }
  EXPECT_NEAR(irradiance, kPi, 0.13);
}

TEST(VirtualLights, PointSpotAndDirectionalStayAsTheyAre) {
  SceneMaker scene;
  scene.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, scene.diffuse(Rgb(0.5f)));
  scene.point_light({0, 0, 1}, {1, 2, 3});
  scenedesc::SpotLightDesc spot;
  spot.to_world = Transform::look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0});
  spot.intensity = Rgb(5);
  spot.cutoff_angle = 30, spot.beam_width = 15;
  scene.light(spot);
  scene.light(scenedesc::DirectionalLightDesc{{0, 0, -1}, Rgb(7)});
  auto settings = light_settings(1, 100);
  settings.indirect = false;
  const auto lights = trace_virtual_lights(scene.build(), settings);
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_EQ(lights.kind, (std::vector<LightKind>{LightKind::omni, LightKind::directional, LightKind::spot}));
  EXPECT_EQ(lights.power[0], Rgb(1, 2, 3));
  EXPECT_EQ(lights.position[0], (Vec3f{0, 0, 1}));
  EXPECT_NEAR(lights.power[1].r, 7, 1e-5);
  EXPECT_NEAR(lights.normal[1].z, -1, 1e-6);
  EXPECT_EQ(lights.power[2], Rgb(5));
  EXPECT_NEAR(lights.normal[2].z, -1, 1e-6);
  ASSERT_LT(lights.closure[2], lights.spots.size());
  const SpotShape& shape = lights.spots[lights.closure[2]];
  EXPECT_NEAR(shape.cutoff, kPi / 6, 1e-6);
  EXPECT_NEAR(shape.beam, kPi / 12, 1e-6);
  EXPECT_NEAR(shape.cos_cutoff, std::cos(kPi / 6), 1e-6);
  EXPECT_NEAR(shape.cos_beam, std::cos(kPi / 12), 1e-6);
}

// In a closed box of reflectance ρ the flux that arrives after k segments is P·ρ^(k-1), P = 4π·I.
TEST(VirtualLights, ParticlesKeepTheEnergyBalanceOfAFurnace) {
  constexpr int kSeeds = 24, kDepths = 5;
  const auto world = furnace(0.6f).build();
  for (const std::size_t count : {500u, 1000u}) {  // whatever the number of paths, by which all is divided
    std::array<std::vector<double>, kDepths + 1> flux;
    for (int seed = 0; seed < kSeeds; ++seed) {
      auto by_depth =
          flux_by_depth(trace_virtual_lights(world, light_settings(static_cast<std::uint64_t>(seed), count)));
      for (int k = 1; k <= kDepths; ++k) flux[static_cast<std::size_t>(k)].push_back(by_depth[k]);
    }
    for (int k = 1; k <= kDepths; ++k)
      expect_mean(flux[static_cast<std::size_t>(k)], 4 * kPi * std::pow(0.6, k - 1), 2 * kDepths,
                  "depth " + std::to_string(k));
  }
}

// Null surfaces in between change nothing, thin glass neither: what it reflects comes back in the end, but
// the straight passages do not count as segments.
TEST(VirtualLights, StraightPassagesDoNotCount) {
  auto scene = furnace(0.6f);
  scene.box_inside(0.7f, scene.bsdf(scenedesc::NullBsdfDesc{}));
  const auto lights = trace_virtual_lights(scene.build(), light_settings(1, 2000));
  auto by_depth = flux_by_depth(lights);
  EXPECT_NEAR(by_depth[1], 4 * kPi, 1e-3);  // all particles arrive with equal powers
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (lights.kind[j] != LightKind::surface) continue;
    const Vec3f p = lights.position[j];
    EXPECT_NEAR(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1, 1e-5);
  }
}

// A mirror of reflectance ρ' in front of the lamp: its light arrives with one segment more.
TEST(VirtualLights, MirrorsAreFollowed) {
  SceneMaker scene;
  scene.box_inside(1, scene.diffuse(Rgb(0.5f)));
  scene.rectangle({0, 0, 0}, {0.9f, 0, 0}, {0, 0.9f, 0}, scene.mirror(Rgb(0.8f)));
  scenedesc::SpotLightDesc spot;  // all its light meets the mirror
  spot.to_world = Transform::look_at({0, 0, 0.5f}, {0, 0, 0}, {0, 1, 0});
  spot.cutoff_angle = 40, spot.beam_width = 40;
  scene.light(spot);
  const auto world = scene.build();
  const double power = 2 * kPi * (1 - std::cos(40 * kPi / 180));
  std::vector<double> flux;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    auto by_depth = flux_by_depth(trace_virtual_lights(world, light_settings(seed, 500)));
    EXPECT_EQ(by_depth.count(1), 0u);  // a mirror is no light
    flux.push_back(by_depth[2]);
  }
  expect_mean(flux, 0.8 * power, 1, "behind the mirror");
}

// Lights per path in a box of reflectance ρ: geometric, mean 1/(1-ρ) = 2.5, variance ρ/(1-ρ)² = 3.75. The
// pilot's mean over 4,096 paths has a relative standard deviation of √(3.75/4096)/2.5 = 1.2 %, the count
// itself over 8,000 paths 0.9 %: together 1.5 %; the bound is five times that.
TEST(VirtualLights, CountIsNearTheTarget) {
  const auto lights = trace_virtual_lights(furnace(0.6f).build(), light_settings(3, 20000));
  EXPECT_EQ(lights.direct_count, 1u);
  EXPECT_NEAR(static_cast<double>(lights.size()), 20000, 0.075 * 20000);
  // Survival is paid by roulette, not by power: all lights of a gray box are alike.
  for (std::size_t j = 0; j < lights.size(); ++j)
    if (lights.kind[j] == LightKind::surface) {
      EXPECT_NEAR(lights.power[j].r * static_cast<float>(lights.paths), 4 * kPi, 1e-3);
    }
}

TEST(VirtualLights, DepthLimit) {
  SceneMaker scene = furnace(0.6f);
  const auto world = scene.build();
  for (const int max_depth : {0, 1, 2, 3, 5}) {
    auto settings = light_settings(1, 1000);
    settings.max_depth = max_depth;
    const auto lights = trace_virtual_lights(world, settings);
    EXPECT_EQ(lights.direct_count, max_depth >= 2 ? 1u : 0u);
    int deepest = 0;
    for (const auto d : lights.depth) deepest = std::max<int>(deepest, d);
    // A first-hit receiver and a light of depth k make a path of k + 2 segments.
    EXPECT_EQ(deepest, std::max(0, max_depth - 2)) << max_depth;
  }
}

TEST(VirtualLights, DirectAndIndirectAlone) {
  const auto world = furnace(0.6f).build();
  auto settings = light_settings(1, 1000);
  settings.indirect = false;
  EXPECT_EQ(trace_virtual_lights(world, settings).size(), 1u);
  settings.indirect = true, settings.direct = false;
  const auto lights = trace_virtual_lights(world, settings);
  EXPECT_EQ(lights.direct_count, 0u);
  for (const auto kind : lights.kind) EXPECT_EQ(kind, LightKind::surface);
}

// Two lamps of unequal power: each path remembers where it began, and the flux at first hits is the lamp's
// own power.
TEST(VirtualLights, RememberTheirEmitter) {
  SceneMaker scene;
  scene.box_inside(1, scene.diffuse(Rgb(0.5f)));
  scene.lamp({0, 0, 0.9f}, {0, 0.5f, 0}, {0.5f, 0, 0}, Rgb(1), scene.diffuse(Rgb(0)), "down");
  scene.lamp({0, 0, -0.9f}, {0.1f, 0, 0}, {0, 0.1f, 0}, Rgb(2), scene.diffuse(Rgb(0)), "up");
  const auto world = scene.build();
  const double power[2] = {kPi * 1 * 1.0, kPi * 2 * 0.04};
  std::array<std::vector<double>, 2> first, direct;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const auto lights = trace_virtual_lights(world, light_settings(seed, 1000));
    std::array<double, 2> f{}, d{};
    for (std::size_t j = 0; j < lights.size(); ++j) {
      const auto e = lights.emitter[j];
      ASSERT_LT(e, 2);
      if (lights.depth[j] == 1) f[e] += lights.power[j].r;
      if (lights.kind[j] == LightKind::oriented) d[e] += lights.power[j].r * kPi;
    }
    for (std::size_t e = 0; e < 2; ++e) first[e].push_back(f[e]), direct[e].push_back(d[e]);
  }
  for (std::size_t e = 0; e < 2; ++e) {
    // The lamps' own black sides catch nothing: no light is made there, but flux is lost to them. The first
    // lamp sees the second under a known form factor, so it is compared by what it sends out alone.
    expect_mean(direct[e], power[e], 4, "direct");
    const auto m = test::mean_of(first[e]);
    EXPECT_LE(m.mean - test::student_quantile(kAlpha, 4, 23) * m.standard_error, power[e]);
    EXPECT_GT(m.mean, 0.5 * power[e]);
  }
}

// More lamps than lights may be: a stratified choice stands for all of them.
TEST(VirtualLights, SomeLampsStandForAll) {
  SceneMaker scene;
  scene.rectangle({0, 0, -1}, {5, 0, 0}, {0, 5, 0}, scene.diffuse(Rgb(0.5f)));
  double total = 0;
  for (int k = 0; k < 500; ++k) {
    const float intensity = 1 + static_cast<float>(k % 10);
    scene.point_light({static_cast<float>(k % 25), static_cast<float>(k / 25), 1}, Rgb(intensity));
    total += intensity;
  }
  const auto world = scene.build();
  std::vector<double> sums;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    auto settings = light_settings(seed, 100);
    settings.indirect = false;
    const auto lights = trace_virtual_lights(world, settings);
    EXPECT_EQ(lights.size(), 100u);
    sums.push_back(total_power(lights, LightKind::omni).r);
  }
  expect_mean(sums, total, 1, "intensity of all lamps");
}

// Half of the box is glossy paint, the rest metal: diffuse lights sit where the full ones of the paint do,
// with the same flux, and shine by its diffuse reflectance alone.
TEST(VirtualLights, DiffuseOnlyKeepsThePlacesAndLeavesOutTheGlossyPart) {
  SceneMaker scene;
  scenedesc::WardDesc paint, metal;
  paint.diffuse_reflectance.value = {0.4f, 0.3f, 0.2f};
  metal.diffuse_reflectance.value = Rgb(0);
  for (auto* d : {&paint, &metal}) {
    d->specular_reflectance.value = Rgb(0.4f);
    d->alpha_u.value = d->alpha_v.value = 0.2f;
  }
  scene.box_inside(1, scene.bsdf(metal));
  scene.rectangle({0, 0, -0.5f}, {0.9f, 0, 0}, {0, 0.9f, 0}, scene.bsdf(paint));
  scene.point_light({0.1f, 0.2f, 0.3f}, Rgb(1));
  const auto world = scene.build();
  auto settings = light_settings(1, 3000);
  settings.direct = false;
  settings.lobes.diffuse_only = true;
  const auto lights = trace_virtual_lights(world, settings);
  ASSERT_GT(lights.size(), 1000u);
  for (std::size_t j = 0; j < lights.size(); ++j) {
    EXPECT_NEAR(lights.position[j].z, -0.5f, 1e-5f);
    EXPECT_EQ(lights.closure[j], VirtualLights::kLambertian);
    EXPECT_EQ(lights.albedo[j], (Rgb{0.4f, 0.3f, 0.2f}));
  }
  EXPECT_EQ(lights.closures.size(), 0u);
  // The flux that arrives at the paint is estimated alike: equal means over independent seeds.
  std::vector<double> difference;
  for (std::uint64_t seed = 10; seed < 30; ++seed) {
    double sum = 0;
    for (const bool diffuse_only : {true, false}) {
      settings.seed = diffuse_only ? seed : seed + 100;
      settings.lobes.diffuse_only = diffuse_only;
      const auto some = trace_virtual_lights(world, settings);
      for (std::size_t j = 0; j < some.size(); ++j)
        if (std::abs(some.position[j].z + 0.5f) < 1e-4f) sum += (diffuse_only ? 1 : -1) * some.power[j].r;
    }
    difference.push_back(sum);
  }
  expect_mean(difference, 0, 1, "flux at the paint");
}

// The same lights with the same flux: only how sharply they shine on differs, on particles and on gather
// samples.
TEST(VirtualLights, ALeastRoughnessWidensWhatTheyShineAndNothingElse) {
  SceneMaker scene;
  scenedesc::ConductorDesc metal;
  metal.alpha_u.value = metal.alpha_v.value = 0.05f;
  scene.box_inside(1, scene.bsdf(metal));
  scene.point_light({0.1f, 0.2f, 0.3f}, Rgb(1));
  const auto world = scene.build();
  for (const bool on_gather_samples : {false, true}) {
    auto settings = light_settings(1, 1000);
    settings.direct = false, settings.max_depth = 4, settings.on_gather_samples = on_gather_samples;
    const auto sharp = trace_virtual_lights(world, settings);
    settings.lobes.least_roughness = 0.3f;
    const auto wide = trace_virtual_lights(world, settings);
    ASSERT_GT(sharp.size(), 500u);
    EXPECT_NEAR(static_cast<double>(wide.size()), static_cast<double>(sharp.size()),
                0.05 * static_cast<double>(sharp.size()));
    double sharp_flux = 0, wide_flux = 0;
    for (std::size_t j = 0; j < sharp.size(); ++j) {
      EXPECT_NEAR(sharp.closure_at(j).roughness(), 0.05f, 1e-5f);
      sharp_flux += sharp.power[j].r;
    }
    for (std::size_t j = 0; j < wide.size(); ++j) {
      EXPECT_NEAR(wide.closure_at(j).roughness(), 0.3f, 1e-5f);
      wide_flux += wide.power[j].r;
    }
    EXPECT_NEAR(wide_flux, sharp_flux, 0.05 * sharp_flux);
  }
}

TEST(VirtualLights, SortedByKindThenAlongACurve) {
  SceneMaker scene;
  const int white = scene.diffuse(Rgb(0.5f));
  scenedesc::PlasticDesc plastic;
  plastic.alpha.value = 0.2f;
  scene.box_inside(1, scene.bsdf(plastic));
  scene.box_inside(0.5f, white);
  scene.rectangle({0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, white);
  scene.point_light({0, 0, 0.4f}, Rgb(1));
  scene.point_light({0, 0, 0.8f}, Rgb(1));
  scene.lamp({0, 0, 0.95f}, {0, 0.05f, 0}, {0.05f, 0, 0}, Rgb(1), white);
  const auto lights = trace_virtual_lights(scene.build(), light_settings(1, 3000));
  const auto sort_of = [&](std::size_t j) {
    return std::pair(lights.kind[j],
                     lights.kind[j] == LightKind::surface && lights.closure[j] != VirtualLights::kLambertian);
  };
  // A Morton curve finishes one octant of the cube [-1, 1]³ before the next: x is the lowest digit. Points
  // within 1e-3 of the middle planes may be counted to either side.
  const auto octant = [&](std::size_t j) {
    const Vec3f p = lights.position[j];
    if (std::min({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 1e-3f) return -1;
    return (p.x > 0 ? 1 : 0) + (p.y > 0 ? 2 : 0) + (p.z > 0 ? 4 : 0);
  };
  std::size_t glossy = 0;
  int latest = -1;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (j > 0) {
      EXPECT_LE(sort_of(j - 1), sort_of(j));
      if (sort_of(j) != sort_of(j - 1)) latest = -1;
    }
    if (sort_of(j).second) {
      EXPECT_EQ(lights.closure[j], glossy);
      ++glossy;
    }
    if (lights.kind[j] == LightKind::surface && octant(j) >= 0) {
      EXPECT_GE(octant(j), latest);
      latest = octant(j);
    }
  }
  EXPECT_GT(glossy, 100u);
  EXPECT_EQ(lights.closures.size(), glossy);
}

void expect_same(const VirtualLights& a, const VirtualLights& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.ng, b.ng);
  EXPECT_EQ(a.power, b.power);
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.emitter, b.emitter);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.closure, b.closure);
  EXPECT_EQ(a.albedo, b.albedo);
  EXPECT_EQ(a.incoming, b.incoming);
  EXPECT_EQ(a.paths, b.paths);
}

TEST(VirtualLights, SameBitsForAnyNumberOfThreads) {
  SceneMaker scene = furnace(0.6f);
  scenedesc::PlasticDesc plastic;
  plastic.alpha.value = 0.2f;
  scene.shape(scenedesc::SphereDesc{{-0.4f, 0, 0}, 0.3f}, {}, scene.bsdf(plastic));
  scene.shape(scenedesc::SphereDesc{{0.4f, 0.4f, 0}, 0.2f}, {}, scene.glass(1.5f));
  scene.light(scenedesc::ConstantEnvironmentDesc{Rgb(1)});
  const auto world = scene.build();
  const world::Camera camera(test::sensor({0, 0, 0}, {1, 1, 1}, {0, 0, 1}, 40, 16, 16));
  const auto receivers = trace_receivers(world, camera, {});
  auto settings = light_settings(5, 10000);
  settings.receivers = &receivers;
  std::array<VirtualLights, 3> runs;
  for (int k = 0; k < 3; ++k)
    with_threads(1 << k, [&] { runs[static_cast<std::size_t>(k)] = trace_virtual_lights(world, settings); });
  expect_same(runs[0], runs[1]);
  expect_same(runs[0], runs[2]);
}

// A closed room whose only opening, a tenth of one wall wide, lets the sky in. `camera` looks from inside.
SceneMaker room_with_a_window() {
  SceneMaker scene;
  scenedesc::TwoSidedDesc both;
  both.front = both.back = scene.diffuse(Rgb(0.5f));
  const int wall = scene.bsdf(both);
  const Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  scene.rectangle(-z, x, y, wall), scene.rectangle(z, x, y, wall);
  scene.rectangle(-y, x, z, wall), scene.rectangle(y, x, z, wall);
  scene.rectangle(-x, y, z, wall);
  scene.rectangle({1, 0.1f, 0}, y * 0.9f, z, wall);             // leaves y in (-1, -0.8)
  scene.rectangle({1, -0.9f, 0.2f}, y * 0.1f, z * 0.8f, wall);  // and of that, z in (-1, -0.6)
  scene.light(scenedesc::ConstantEnvironmentDesc{Rgb(1)});
  return scene;
}
bool is_inside(Vec3f normal, Vec3f position) { return dot(normal, position) < 0; }

TEST(VirtualLights, AreAimedAtWhatReceiversSee) {
  const auto world = room_with_a_window().build();
  const world::Camera camera(test::sensor({-0.9f, 0.9f, 0.9f}, {0.5f, -0.5f, -0.5f}, {0, 0, 1}, 60, 32, 32));
  const auto receivers = trace_receivers(world, camera, {});
  constexpr int kSeeds = 16;
  std::array<std::vector<double>, 2> flux, inside;  // without and with receivers
  for (int seed = 0; seed < kSeeds; ++seed)
    for (std::size_t aimed = 0; aimed < 2; ++aimed) {
      auto settings = light_settings(static_cast<std::uint64_t>(seed), 4000);
      settings.direct = false;
      settings.receivers = aimed ? &receivers : nullptr;
      const auto lights = trace_virtual_lights(world, settings);
      double sum = 0, count = 0;
      for (std::size_t j = 0; j < lights.size(); ++j) {
        if (!is_inside(lights.normal[j], lights.position[j])) continue;
        sum += lights.power[j].r, ++count;
      }
      flux[aimed].push_back(sum), inside[aimed].push_back(count / static_cast<double>(lights.size()));
    }
  // The same flux arrives inside, carried by more lights.
  std::vector<double> difference;
  for (std::size_t k = 0; k < flux[0].size(); ++k) difference.push_back(flux[1][k] - flux[0][k]);
  const auto m = test::mean_of(difference);
  EXPECT_NEAR(m.mean, 0, test::student_quantile(kAlpha, 1, kSeeds - 1) * m.standard_error);
  EXPECT_GT(test::mean_of(inside[1]).mean, 2 * test::mean_of(inside[0]).mean);
  // And the flux inside is known better for the same number of lights.
  EXPECT_LT(test::mean_of(flux[1]).standard_error, test::mean_of(flux[0]).standard_error);
}

// The guide may prefer what it likes; energy stays in balance (compare the furnace without receivers above).
TEST(VirtualLights, AimingKeepsTheEnergyBalance) {
  constexpr int kSeeds = 12, kDepths = 4;
  const auto world = furnace(0.6f).build();
  const world::Camera corner(test::sensor({0, 0, 0}, {1, 1, 1}, {0, 0, 1}, 10, 8, 8));
  const auto receivers = trace_receivers(world, corner, {});
  std::array<std::vector<double>, kDepths + 1> flux;
  for (int seed = 0; seed < kSeeds; ++seed) {
    auto settings = light_settings(static_cast<std::uint64_t>(seed), 1000);
    settings.receivers = &receivers;
    auto by_depth = flux_by_depth(trace_virtual_lights(world, settings));
    for (int k = 1; k <= kDepths; ++k) flux[static_cast<std::size_t>(k)].push_back(by_depth[k]);
  }
  for (int k = 1; k <= kDepths; ++k)
    expect_mean(flux[static_cast<std::size_t>(k)], 4 * kPi * std::pow(0.6, k - 1), kDepths,
                "depth " + std::to_string(k));
}

TEST(VirtualLights, NothingShines) {
  SceneMaker scene;
  scene.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, scene.diffuse(Rgb(0.5f)));
  EXPECT_EQ(trace_virtual_lights(scene.build(), light_settings(1, 100)).size(), 0u);
}

TEST(VirtualLights, ZeroLightsIsAnError) {
  EXPECT_THROW(trace_virtual_lights(furnace(0.5f).build(), light_settings(1, 0)), InputError);
}

}  // namespace
}  // namespace lumirank::transport
