#include "transport/rows/receivers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/rows/film_order.h"

namespace lumirank::transport {
namespace {

using test::SceneMaker;
using world::Camera;

ReceiverSettings settings_of(int spp, int max_depth = -1) {
  ReceiverSettings s;
  s.spp = spp, s.max_depth = max_depth;
  return s;
}

// A white floor at z = 0 seen from above.
SceneMaker floor_scene() {
  SceneMaker scene;
  scene.rectangle({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, scene.diffuse({0.2f, 0.4f, 0.6f}));
  return scene;
}
Camera from_above(int width, int height) {
  return Camera(test::sensor({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 40, width, height));
}

TEST(Receivers, FirstHitsOfADiffuseFloor) {
  const auto world = floor_scene().build();
  const Camera camera = from_above(10, 6);
  const auto r = trace_receivers(world, camera, settings_of(4));
  EXPECT_EQ(r.width, 10);
  EXPECT_EQ(r.height, 6);
  ASSERT_EQ(r.samples(), 10u * 6 * 4);
  ASSERT_EQ(r.size(), r.samples());
  for (std::size_t i = 0; i < r.size(); ++i) {
    const auto s = r.sample[i];
    const auto ray = camera.ray(r.film[s], {0.5f, 0.5f});
    const float t = -ray.origin.z / ray.direction.z;
    const Vec3f expected = ray.origin + ray.direction * t;
    EXPECT_LT(length(r.position[i] - expected), 1e-5f);
    EXPECT_LT(length(r.wo[i] + ray.direction), 1e-6f);
    EXPECT_EQ(r.normal[i], (Vec3f{0, 0, 1}));
    EXPECT_EQ(r.ng[i], (Vec3f{0, 0, 1}));
    EXPECT_EQ(r.weight[i], Rgb(1));
    EXPECT_EQ(r.depth[i], 1);
    EXPECT_EQ(r.closure[i], Receivers::kLambertian);
    EXPECT_EQ(r.albedo[i], Rgb(0.2f, 0.4f, 0.6f));
    EXPECT_EQ(r.emission[s], Rgb(0));
    EXPECT_LT(length(r.first_position[s] - expected), 1e-5f);
    EXPECT_NEAR(r.first_distance[s], t, 1e-5f);
    EXPECT_EQ(r.first_normal[s], (Vec3f{0, 0, 1}));
    EXPECT_NEAR(r.first_albedo[s].g, 0.4f, 1e-6f);
    EXPECT_TRUE(r.closure_at(i).is_lambertian());
  }
}

// Every pixel holds spp samples: one in each cell of the grid, or one in each of spp rows and columns.
TEST(Receivers, FilmSamplesAreStratified) {
  const auto world = floor_scene().build();
  for (const int spp : {1, 2, 3, 4, 5, 6, 9, 12, 16}) {
    const auto r = trace_receivers(world, from_above(7, 5), settings_of(spp));
    std::map<std::pair<int, int>, std::vector<Vec2f>> pixels;
    for (const Vec2f f : r.film) {
      const int x = static_cast<int>(f.x), y = static_cast<int>(f.y);
      pixels[{x, y}].push_back({f.x - static_cast<float>(x), f.y - static_cast<float>(y)});
    }
    ASSERT_EQ(pixels.size(), 35u);
    const std::map<int, std::pair<int, int>> grids{{1, {1, 1}}, {2, {2, 1}},  {4, {2, 2}}, {6, {3, 2}},
                                                   {9, {3, 3}}, {12, {4, 3}}, {16, {4, 4}}};
    for (const auto& [pixel, places] : pixels) {
      ASSERT_EQ(places.size(), static_cast<std::size_t>(spp));
      std::set<std::pair<int, int>> cells;
      std::set<int> columns, rows;
      const auto grid = grids.contains(spp) ? grids.at(spp) : std::pair(spp, spp);
      for (const Vec2f p : places) {
        const int cx = static_cast<int>(p.x * static_cast<float>(grid.first));
        const int cy = static_cast<int>(p.y * static_cast<float>(grid.second));
        cells.insert({cx, cy}), columns.insert(cx), rows.insert(cy);
      }
      EXPECT_EQ(cells.size(), places.size()) << spp;
      EXPECT_EQ(columns.size(), static_cast<std::size_t>(grid.first)) << spp;
      EXPECT_EQ(rows.size(), static_cast<std::size_t>(grid.second)) << spp;
    }
  }
}

// Film stratum and lens stratum are paired at random: over many pixels all 16 pairs of a 2×2 pattern come up
// alike. Each film cell meets one lens cell per pixel, so each of the 16 counts is binomial(n, 1/4); with a
// permutation per pixel the chi-square statistic Σ(o-e)²/e has 9 degrees of freedom after scaling by 3/4.
TEST(Receivers, LensIsNotCorrelatedWithFilm) {
  constexpr int kPixels = 4000;
  std::array<std::array<int, 4>, 4> counts{};
  for (int pixel = 0; pixel < kPixels; ++pixel) {
    const PixelPattern pattern(4, hash_ids(1, Stage::test, static_cast<std::uint64_t>(pixel)));
    std::set<int> lens_cells;
    for (int k = 0; k < 4; ++k) {
      const auto place = pattern.place(k, {0.5f, 0.5f}, {0.5f, 0.5f});
      const auto cell = [](Vec2f p) { return (p.x > 0.5f ? 1 : 0) + (p.y > 0.5f ? 2 : 0); };
      ++counts[static_cast<std::size_t>(cell(place.film))][static_cast<std::size_t>(cell(place.lens))];
      lens_cells.insert(cell(place.lens));
    }
    ASSERT_EQ(lens_cells.size(), 4u);
  }
  double chi2 = 0;
  constexpr double expected = kPixels / 4.0;
  for (const auto& row : counts)
    for (const int c : row) chi2 += (c - expected) * (c - expected) / expected;
  // For uniform permutations Σ(o-e)²/e · (4-1)/4 is asymptotically χ² with (4-1)² = 9 degrees of freedom,
  // whose 99.99 % quantile is 33.7.
  EXPECT_LT(chi2 * 3 / 4, 33.7);
}

TEST(Receivers, InMortonOrderOfTiles) {
  const auto world = floor_scene().build();
  const auto r = trace_receivers(world, from_above(37, 22), settings_of(4));
  const FilmOrder order(37, 22);
  std::map<std::pair<int, int>, std::size_t> rank;
  for (std::size_t t = 0; t < order.tiles.size(); ++t)
    rank[{order.tiles[t].x / kTile, order.tiles[t].y / kTile}] = t;
  EXPECT_EQ(rank.size(), 10u * 6);
  std::size_t previous = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const Vec2f f = r.film[r.sample[i]];
    const std::size_t tile = rank.at({static_cast<int>(f.x) / kTile, static_cast<int>(f.y) / kTile});
    EXPECT_GE(tile, previous);
    previous = tile;
  }
}

// A camera at (0, -1, 1) looks down at a mirror in z = 0 under 45° and sees in it a wall in the plane y = 2.
SceneMaker mirror_scene(Rgb reflectance) {
  SceneMaker scene;
  scene.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, scene.mirror(reflectance));
  auto& wall = scene.lamp({0, 2, 2}, {10, 0, 0}, {0, 0, 10}, {3, 2, 1}, scene.diffuse(Rgb(0.5f)));
  (void)wall;  // u × v = -y: towards the mirror
  return scene;
}
Camera mirror_camera() { return Camera(test::sensor({0, -1, 1}, {0, 0, 0}, {0, 0, 1}, 20, 6, 6)); }

TEST(Receivers, FollowAPlaneMirror) {
  const Rgb reflectance(0.9f, 0.8f, 0.7f);
  const auto world = mirror_scene(reflectance).build();
  const Camera camera = mirror_camera();
  const auto r = trace_receivers(world, camera, settings_of(4));
  ASSERT_EQ(r.size(), r.samples());
  for (std::size_t i = 0; i < r.size(); ++i) {
    const auto ray = camera.ray(r.film[r.sample[i]], {0.5f, 0.5f});
    // Mirrored about z = 0, the eye ray goes on from the mirror image of the eye.
    const Vec3f origin{ray.origin.x, ray.origin.y, -ray.origin.z};
    const Vec3f direction{ray.direction.x, ray.direction.y, -ray.direction.z};
    const Vec3f expected = origin + direction * ((2 - origin.y) / direction.y);
    EXPECT_LT(length(r.position[i] - expected), 1e-4f);
    EXPECT_LT(length(r.wo[i] + direction), 1e-5f);
    EXPECT_EQ(r.depth[i], 2);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(r.weight[i][c], reflectance[c], 1e-5f);
      const float le[3] = {3, 2, 1};
      EXPECT_NEAR(r.emission[r.sample[i]][c], reflectance[c] * le[c], 1e-4f);
    }
    EXPECT_NEAR(r.first_normal[r.sample[i]].z, 1, 1e-6f);
  }
}

// Mitsuba's count: emission seen in the mirror is a path of 2 segments, direct light seen in it one of 3.
TEST(Receivers, DepthLimitCountsMirrors) {
  const auto world = mirror_scene(Rgb(1)).build();
  for (const int max_depth : {0, 1, 2, 3}) {
    const auto r = trace_receivers(world, mirror_camera(), settings_of(1, max_depth));
    EXPECT_EQ(r.size(), max_depth >= 3 ? r.samples() : 0u) << max_depth;
    EXPECT_EQ(r.emission[0].r > 0, max_depth >= 2) << max_depth;
  }
  const auto floor = floor_scene().build();
  EXPECT_EQ(trace_receivers(floor, from_above(4, 4), settings_of(1, 1)).size(), 0u);
  EXPECT_EQ(trace_receivers(floor, from_above(4, 4), settings_of(1, 2)).size(), 16u);
}

TEST(Receivers, EmissionSeenDirectlyAndFromBehind) {
  SceneMaker scene;
  scene.lamp({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {3, 2, 1}, scene.diffuse(Rgb(0.5f)));
  const auto world = scene.build();
  const auto above = trace_receivers(world, from_above(4, 4), settings_of(4, 1));
  for (const Rgb e : above.emission) EXPECT_EQ(e, Rgb(3, 2, 1));
  const Camera below(test::sensor({0, 0, -4}, {0, 0, 0}, {0, 1, 0}, 40, 4, 4));
  for (const Rgb e : trace_receivers(world, below, settings_of(4)).emission) EXPECT_EQ(e, Rgb(0));
}

TEST(Receivers, BackgroundIsEmission) {
  SceneMaker scene;
  scene.rectangle({0, 0, -50}, {1, 0, 0}, {0, 1, 0}, scene.diffuse(Rgb(0.5f)));
  scene.light(scenedesc::ConstantEnvironmentDesc{{1, 2, 3}});
  const Camera up(test::sensor({0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 40, 4, 4));
  const auto r = trace_receivers(scene.build(), up, settings_of(1));
  EXPECT_EQ(r.size(), 0u);
  for (const Rgb e : r.emission) EXPECT_EQ(e, Rgb(1, 2, 3));
  for (const float d : r.first_distance) EXPECT_EQ(d, kInfinity);
}

// Straight through a slab of glass, at normal incidence: the ray neither bends nor shifts. Each face passes 1
// - F, F = ((η-1)/(η+1))² (what refraction does to radiance at the first face, the second undoes); the next
// heavier chain is the one that is reflected twice inside: (1-F)²·F². All weights of one sample, over
// infinitely many chains, add up to T = (1-F)/(1+F).
TEST(Receivers, GlassSlabStraightThrough) {
  const float eta = 1.5f, f = 0.04f;
  SceneMaker scene = floor_scene();
  const int glass = scene.glass(eta);
  scene.rectangle({0, 0, 2}, {10, 0, 0}, {0, 10, 0}, glass);     // outside up
  scene.rectangle({0, 0, 1.5f}, {0, 10, 0}, {10, 0, 0}, glass);  // outside down
  const Camera camera(test::orthographic({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 1, 16, 16));
  const auto r = trace_receivers(scene.build(), camera, settings_of(4));
  std::vector<int> heaviest(r.samples(), 0);
  std::vector<double> sums(r.samples(), 0);
  for (std::size_t i = 0; i < r.size(); ++i) {
    const auto s = r.sample[i];
    sums[s] += r.weight[i].r;
    const auto ray = camera.ray(r.film[s], {0.5f, 0.5f});
    EXPECT_NEAR(r.position[i].x, ray.origin.x, 1e-5f);
    EXPECT_NEAR(r.position[i].y, ray.origin.y, 1e-5f);
    if (r.depth[i] != 3) continue;
    ++heaviest[s];
    EXPECT_NEAR(r.weight[i].r, (1 - f) * (1 - f), 1e-5f);
  }
  for (const int h : heaviest) EXPECT_EQ(h, 1);
  const auto m = test::mean_of(sums);
  EXPECT_NEAR(m.mean, (1 - f) / (1 + f), test::normal_quantile(1e-4) * m.standard_error);
}

// Thin glass lets the eye look straight through without counting a segment; its weight is (1-F)/(1+F) for
// both faces.
TEST(Receivers, ThinGlassIsNoVertex) {
  SceneMaker scene = floor_scene();
  scenedesc::ThinDielectricDesc thin;
  thin.eta = 1.5f;
  scene.rectangle({0, 0, 2}, {10, 0, 0}, {0, 10, 0}, scene.bsdf(thin));
  scene.rectangle({0, 0, 1}, {10, 0, 0}, {0, 10, 0}, scene.bsdf(scenedesc::NullBsdfDesc{}));
  const Camera camera(test::orthographic({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 1, 4, 4));
  const auto r = trace_receivers(scene.build(), camera, settings_of(1, 2));
  ASSERT_EQ(r.size(), r.samples());
  for (std::size_t i = 0; i < r.size(); ++i) {
    EXPECT_EQ(r.depth[i], 1);
    EXPECT_NEAR(r.weight[i].r, 0.96f / 1.04f, 1e-5f);
  }
}

// Clear glass in white light is invisible: chains split, are drawn and played at roulette, but what they
// bring is 1 in the mean.
TEST(Receivers, GlassSphereInAWhiteFurnace) {
  SceneMaker scene;
  scene.shape(scenedesc::SphereDesc{{0, 0, 0}, 1}, {}, scene.glass(1.5f));
  scene.light(scenedesc::ConstantEnvironmentDesc{Rgb(1)});
  const auto world = scene.build();
  const Camera camera(test::sensor({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 26, 32, 32));
  for (const int splits : {0, 3}) {
    auto settings = settings_of(4);
    settings.max_splits = splits;
    const auto r = trace_receivers(world, camera, settings);
    EXPECT_EQ(r.size(), 0u);
    std::vector<double> seen;
    for (const Rgb e : r.emission) seen.push_back(e.r);
    const auto m = test::mean_of(seen);
    EXPECT_NEAR(m.mean, 1, test::normal_quantile(1e-4, 2) * m.standard_error + 1e-5) << splits;
  }
}

// Two facing perfect mirrors: without a depth limit the chain still ends.
TEST(Receivers, EndlessMirrorsEnd) {
  SceneMaker scene;
  scene.box_inside(1, scene.mirror(Rgb(1)));
  const Camera camera(test::sensor({0, 0, 0}, {1, 0.3f, 0.2f}, {0, 0, 1}, 40, 4, 4));
  EXPECT_EQ(trace_receivers(scene.build(), camera, settings_of(4)).size(), 0u);
}

SceneMaker varied_scene() {
  SceneMaker scene = floor_scene();
  scene.shape(scenedesc::SphereDesc{{-0.8f, 0, 1}, 0.5f}, {}, scene.glass(1.5f));
  scenedesc::PlasticDesc plastic;
  scene.shape(scenedesc::SphereDesc{{0.8f, 0, 1}, 0.5f}, {}, scene.bsdf(plastic));
  plastic.alpha.value = 0.2f;
  scene.shape(scenedesc::SphereDesc{{0, 0.8f, 0.5f}, 0.5f}, {}, scene.bsdf(plastic));
  scene.lamp({0, 0, 10}, {0, 1, 0}, {1, 0, 0}, Rgb(5), scene.diffuse(Rgb(0.5f)));
  scene.light(scenedesc::ConstantEnvironmentDesc{Rgb(0.5f)});
  return scene;
}

void expect_same(const Receivers& a, const Receivers& b) {
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.ng, b.ng);
  EXPECT_EQ(a.wo, b.wo);
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.sample, b.sample);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.closure, b.closure);
  EXPECT_EQ(a.albedo, b.albedo);
  EXPECT_EQ(a.film, b.film);
  EXPECT_EQ(a.emission, b.emission);
  EXPECT_EQ(a.first_albedo, b.first_albedo);
}

TEST(Receivers, SameBitsForAnyNumberOfThreads) {
  const auto world = varied_scene().build();
  std::array<Receivers, 3> runs;
  for (int k = 0; k < 3; ++k)
    with_threads(1 << k, [&] {
      runs[static_cast<std::size_t>(k)] = trace_receivers(world, from_above(90, 70), settings_of(4));
    });
  EXPECT_GT(runs[0].closures.size(), 100u);
  expect_same(runs[0], runs[1]);
  expect_same(runs[0], runs[2]);
}

TEST(Receivers, ACropShowsTheSamePicture) {
  const auto world = varied_scene().build();
  const Camera camera = from_above(40, 30);
  auto settings = settings_of(4);
  const auto whole = trace_receivers(world, camera, settings);
  settings.crop_x = 13, settings.crop_y = 7, settings.crop_width = 11, settings.crop_height = 9;
  const auto part = trace_receivers(world, camera, settings);
  ASSERT_EQ(part.samples(), 11u * 9 * 4);
  std::map<std::pair<float, float>, std::size_t> at;
  for (std::size_t s = 0; s < whole.samples(); ++s) at[{whole.film[s].x, whole.film[s].y}] = s;
  for (std::size_t s = 0; s < part.samples(); ++s) {
    const auto found = at.find({part.film[s].x, part.film[s].y});
    ASSERT_NE(found, at.end());
    EXPECT_EQ(part.emission[s], whole.emission[found->second]);
    EXPECT_EQ(part.first_position[s], whole.first_position[found->second]);
  }
}

// Sets of interleaved pixels, in any window, have the receivers of the whole picture between them.
TEST(Receivers, OfInterleavedPixelsAreThoseOfThePicture) {
  const auto world = varied_scene().build();
  const Camera camera = from_above(40, 30);
  auto settings = settings_of(1);
  settings.crop_x = 13, settings.crop_y = 7, settings.crop_width = 11, settings.crop_height = 9;
  const auto whole = trace_receivers(world, camera, settings);
  std::map<std::uint64_t, Vec3f> at;
  for (int k = 0; k < 4; ++k) {
    settings.pixels = film::interleaved(2, k);
    const auto part = trace_receivers(world, camera, settings);
    EXPECT_EQ(part.samples(), whole.samples());
    EXPECT_LT(part.size(), whole.size() / 2);
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Vec2f film = part.film[part.sample[i]];
      EXPECT_TRUE(settings.pixels.has(static_cast<int>(film.x), static_cast<int>(film.y)));
      EXPECT_TRUE(at.emplace(part.id[i], part.position[i]).second);
    }
  }
  ASSERT_EQ(at.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(at.at(whole.id[i]), whole.position[i]);
}

TEST(Receivers, RefusesBadSettings) {
  const auto world = floor_scene().build();
  EXPECT_THROW(trace_receivers(world, from_above(4, 4), settings_of(0)), InputError);
  auto settings = settings_of(1);
  settings.crop_x = 3, settings.crop_width = 2, settings.crop_height = 2;
  EXPECT_THROW(trace_receivers(world, from_above(4, 4), settings), InputError);
}

// Without its sharp lobe, plastic is matt and metal is no receiver at all; film samples stay.
TEST(Receivers, TheBroadPartHasNoSharpLobes) {
  SceneMaker scene;
  scenedesc::PlasticDesc plastic;
  plastic.alpha.value = 0.1f;
  scenedesc::ConductorDesc metal;
  metal.alpha_u.value = metal.alpha_v.value = 0.1f;
  scene.rectangle({-2, 0, 0}, {1, 0, 0}, {0, 10, 0}, scene.bsdf(plastic));
  scene.rectangle({0, 0, 0}, {1, 0, 0}, {0, 10, 0}, scene.bsdf(metal));
  scene.rectangle({2, 0, 0}, {1, 0, 0}, {0, 10, 0}, scene.diffuse({0.2f, 0.4f, 0.6f}));
  const auto world = scene.build();
  const auto all = trace_receivers(world, from_above(32, 8), settings_of(4));
  const auto broad = broad_receivers(all, 0.15f);
  EXPECT_EQ(broad.samples(), all.samples());
  std::size_t k = 0, metals = 0, plastics = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const float x = all.position[i].x;
    if (x > -1 && x < 1) {
      ++metals;
      continue;
    }
    ASSERT_LT(k, broad.size());
    EXPECT_EQ(broad.position[k], all.position[i]);
    EXPECT_EQ(broad.wo[k], all.wo[i]);
    EXPECT_EQ(broad.sample[k], all.sample[i]);
    if (x < -1) {
      ++plastics;
      const scatter::Closure whole = all.closure_at(i), part = broad.closure_at(k);
      const Vec3f wi = normalize(Vec3f{0.3f, 0.2f, 1});
      EXPECT_LT(max_component(scatter::eval(scatter::broad_part(whole, 0.15f), all.wo[i], wi) -
                              scatter::eval(part, broad.wo[k], wi)),
                1e-6f);
      EXPECT_GE(part.roughness(), 0.15f);
    } else {
      EXPECT_EQ(broad.albedo[k], all.albedo[i]);
    }
    ++k;
  }
  EXPECT_EQ(k, broad.size());
  EXPECT_GT(metals, 0u);
  EXPECT_GT(plastics, 0u);
  EXPECT_EQ(broad_receivers(all, 0.05f).size(), all.size());
}

TEST(Receivers, WithoutFirstHitsThereAreNone) {
  auto settings = settings_of(4);
  settings.first_hits = false;
  const auto world = floor_scene().build();
  const auto without = trace_receivers(world, from_above(32, 32), settings);
  EXPECT_TRUE(without.first_albedo.empty());
  settings.first_hits = true;
  const auto with = trace_receivers(world, from_above(32, 32), settings);
  EXPECT_EQ(with.memory_bytes() - without.memory_bytes(), 40u * 32 * 32 * 4);
}

}  // namespace
}  // namespace lumirank::transport
