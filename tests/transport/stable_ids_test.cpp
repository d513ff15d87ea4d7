// Rows and columns are who they are by what made them: entries do not change with the order of receivers and
// lights, or with how many others there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "matrix_fixture.h"
#include "support/scenes.h"
#include "transport/lights/sphere_lights.h"

namespace lumirank::transport::testing {
namespace {

using matrix::Part;

template <typename T>
std::vector<T> picked(const std::vector<T>& all, std::span<const std::uint32_t> which) {
  std::vector<T> some;
  if (!all.empty())
    for (const std::uint32_t k : which) some.push_back(all[k]);
  return some;
}

// Pools of closures and tables stay whole: what is picked refers to them by number.
VirtualLights picked(const VirtualLights& all, std::span<const std::uint32_t> which) {
  VirtualLights some = all;
  const auto pick = [&](auto&... lists) { ((lists = picked(lists, which)), ...); };
  pick(some.kind, some.position, some.normal, some.ng, some.power, some.area, some.radius, some.hidden,
       some.emitter, some.depth, some.id, some.path, some.half, some.closure, some.albedo, some.incoming);
  return some;
}
Receivers picked(const Receivers& all, std::span<const std::uint32_t> which) {
  Receivers some = all;
  const auto pick = [&](auto&... lists) { ((lists = picked(lists, which)), ...); };
  pick(some.position, some.normal, some.ng, some.wo, some.weight, some.id, some.sample, some.depth,
       some.closure, some.albedo);
  return some;
}

// A third of 0 … n - 1 left out, the rest in disorder.
std::vector<std::uint32_t> some_of(std::size_t n, std::uint64_t seed) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  Rng rng(seed, Stage::test);
  for (std::size_t k = n; k > 1; --k) std::swap(order[k - 1], order[rng.next_below(k)]);
  order.resize(n - n / 3);
  return order;
}

std::vector<Rgb> all_entries(const SceneMatrix& matrix, Part part) {
  std::vector<Rgb> out(matrix.rows() * matrix.columns());
  for (matrix::Index i = 0; i < matrix.rows(); ++i)
    matrix.row(i, std::span(out).subspan(i * matrix.columns(), matrix.columns()), part);
  return out;
}

// Spherical lights are integrated with random numbers, cut-outs decide visibilities by them.
TEST(StableIds, EntriesAreTheSameAmongOthersAndInAnotherOrder) {
  scenedesc::SceneDesc desc = room_with_blocks();
  add_all_bsdfs(desc);
  scenedesc::MaskDesc mask;
  mask.nested = add_bsdf(desc, scenedesc::DiffuseDesc{});
  add_shape(desc, scenedesc::CubeDesc{}, Transform::scale(1.2, 1.2, 1.2), add_bsdf(desc, mask));
  const world::World world = build_world(desc);
  RandomEnds ends = random_ends(world, 200, 300, 5);
  make_spherical(ends.lights, world, {2});
  const std::vector<std::uint32_t> rows = some_of(200, 1), columns = some_of(300, 2);
  const Receivers receivers = picked(ends.receivers, rows);
  const VirtualLights lights = picked(ends.lights, columns);
  const SceneMatrix whole(world, ends.receivers, ends.lights, {}), part(world, receivers, lights, {});
  for (const Part wanted : {Part::unoccluded, Part::visibility}) {
    const std::vector<Rgb> a = all_entries(whole, wanted), b = all_entries(part, wanted);
    std::size_t grazing = 0, lit = 0;
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < columns.size(); ++j) {
        const Rgb before = a[rows[i] * ends.lights.size() + columns[j]], after = b[i * lights.size() + j];
        lit += !is_black(before);
        if (before == after) continue;
        // Rays that graze an edge are hidden or not by what they are packed with.
        EXPECT_EQ(wanted, Part::visibility) << rows[i] << ' ' << columns[j];
        ++grazing;
      }
    EXPECT_LE(grazing, b.size() / 2000);
    EXPECT_GT(lit, b.size() / 50);
  }
}

// Keys decide: with others the same pairs have other numbers, so the test above has teeth.
TEST(StableIds, OtherIdsHaveOtherNumbers) {
  const world::World world = build_world(room_with_blocks());
  RandomEnds ends = random_ends(world, 50, 60, 5);
  make_spherical(ends.lights, world, {2});
  const std::vector<Rgb> before =
      all_entries(SceneMatrix(world, ends.receivers, ends.lights, {}), Part::unoccluded);
  for (std::uint64_t& id : ends.lights.id) id += 1000;
  const std::vector<Rgb> after =
      all_entries(SceneMatrix(world, ends.receivers, ends.lights, {}), Part::unoccluded);
  EXPECT_NE(before, after);
}

// Spheres, and the share of each that is behind walls, are found by rays that the light's id draws.
TEST(StableIds, SpheresAreTheSameInAnotherOrder) {
  const world::World world = build_world(room_with_blocks());
  RandomEnds ends = random_ends(world, 1, 300, 5);
  std::vector<std::uint32_t> order(300);
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::uint32_t>((k * 77 + 13) % 300);
  VirtualLights other = picked(ends.lights, order);
  make_spherical(ends.lights, world, {2});
  make_spherical(other, world, {2});
  std::size_t partly = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    EXPECT_EQ(other.radius[k], ends.lights.radius[order[k]]);
    EXPECT_EQ(other.hidden[k], ends.lights.hidden[order[k]]);
    partly += other.hidden[k] > 0 && other.hidden[k] < 1;
  }
  EXPECT_GT(partly, 20u);
}

test::SceneMaker mixed_scene() {
  test::SceneMaker scene;
  scene.rectangle({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, scene.diffuse(Rgb(0.7f)));
  scene.shape(scenedesc::SphereDesc{{-0.8f, 0, 1}, 0.5f}, {}, scene.glass(1.5f));
  scene.shape(scenedesc::SphereDesc{{0.8f, 0, 1}, 0.5f}, {}, scene.bsdf(scenedesc::PlasticDesc{}));
  scene.lamp({0, 0, 10}, {0, 1, 0}, {1, 0, 0}, Rgb(5), scene.diffuse(Rgb(0.5f)));
  scene.light(scenedesc::ConstantEnvironmentDesc{Rgb(0.5f)});
  return scene;
}

TEST(StableIds, OfLightsAreUnique) {
  const auto world = mixed_scene().build();
  LightSettings settings;
  settings.count = 20000;
  const VirtualLights lights = trace_virtual_lights(world, settings);
  ASSERT_EQ(lights.id.size(), lights.size());
  const std::set<std::uint64_t> ids(lights.id.begin(), lights.id.end());
  EXPECT_EQ(ids.size(), lights.size());
  EXPECT_GT(lights.size() - lights.direct_count, 1000u);
  EXPECT_GT(lights.direct_count, 100u);
}

// The chains of a sample have several receivers; a window has those of the whole film that it shows.
TEST(StableIds, OfReceiversAreUniqueAndThoseOfTheWholeFilm) {
  const auto world = mixed_scene().build();
  const world::Camera camera(test::sensor({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 40, 40, 30));
  ReceiverSettings settings;
  settings.spp = 4;
  const Receivers whole = trace_receivers(world, camera, settings);
  std::map<std::uint64_t, Vec3f> places;
  for (std::size_t i = 0; i < whole.size(); ++i) places[whole.id[i]] = whole.position[i];
  EXPECT_EQ(places.size(), whole.size());
  EXPECT_GT(whole.size(), whole.samples());
  settings.crop_x = 7, settings.crop_y = 5, settings.crop_width = 20, settings.crop_height = 17;
  const Receivers window = trace_receivers(world, camera, settings);
  EXPECT_GT(window.size(), 1000u);
  for (std::size_t i = 0; i < window.size(); ++i) {
    const auto found = places.find(window.id[i]);
    ASSERT_NE(found, places.end());
    EXPECT_EQ(found->second, window.position[i]);
  }
  // Of every sample's first hit, and of the broad parts of receivers.
  const Receivers white = white_receivers(whole), white_window = white_receivers(window);
  const std::set<std::uint64_t> white_ids(white.id.begin(), white.id.end());
  EXPECT_EQ(white_ids.size(), white.size());
  for (const std::uint64_t id : white_window.id) EXPECT_TRUE(white_ids.contains(id));
  for (const std::uint64_t id : broad_receivers(window, 0.1f).id) EXPECT_TRUE(places.contains(id));
}

}  // namespace
}  // namespace lumirank::transport::testing
