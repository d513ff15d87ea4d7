// Participating media, written as Mitsuba 3 XML and read again. tests/world compares what is built of them.
#include <gtest/gtest.h>

#include <fstream>

#include "mesh_builders.h"
#include "round_trip.h"
#include "scenedesc/volumes/vol_file.h"
#include "sparse_files.h"

namespace lumirank::scenedesc {
namespace {

GridData some_numbers(std::array<int, 3> size, int channels, float scale = 1) {
  GridData grid;
  grid.size = size, grid.channels = channels;
  grid.lo = {-1, 0, 2}, grid.hi = {1, 4, 3};
  for (int k = 0; k < size[0] * size[1] * size[2] * channels; ++k)
    grid.values.push_back(scale * static_cast<float>((7 * k) % 10) / 10);
  return grid;
}

// A scene with a camera and a cube, its inside medium 0.
SceneDesc cube_of_a_medium() {
  SceneDesc scene;
  scene.sensors.emplace_back();
  scene.bsdfs.emplace_back().kind = NullBsdfDesc{};
  ShapeDesc& cube = scene.shapes.emplace_back();
  cube.kind = CubeDesc{}, cube.bsdf = 0;
  cube.media = {true, 0, kNone};
  scene.media.emplace_back();
  scene.media[0].where = {"scene.pbrt", 7};
  return scene;
}

int add_grid(SceneDesc& scene, GridData grid, GridSampling sampling = GridSampling::centers) {
  VolumeDesc& v = scene.volumes.emplace_back();
  v.where = {"scene.pbrt", 5};
  v.sampling = sampling;
  v.kind = std::make_shared<const GridData>(std::move(grid));
  return static_cast<int>(scene.volumes.size()) - 1;
}

GridData numbers_of(const VolumeDesc& volume) {
  return read_vol(std::get<GridFileDesc>(volume.kind).filename);
}

std::string all_warnings(const WrittenScene& written) {
  std::string text;
  for (const Warning& w : written.warnings) text += w.what + "; " + w.used_instead + "\n";
  return text;
}

TEST(WrittenMedia, WhatMitsubaHasComesBack) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "smoke.vol", std::ios::binary) << vol_bytes(some_numbers({4, 3, 2}, 1));
  std::ofstream(folder / "colors.vol", std::ios::binary) << vol_bytes(some_numbers({2, 2, 2}, 3));
  SceneDesc scene = cube_of_a_medium();
  scene.volumes.resize(2);
  scene.volumes[0].id = "density";
  scene.volumes[0].kind = GridFileDesc{folder / "smoke.vol", false};
  scene.volumes[0].to_world = Transform::rotate(1, 2, 3, 40) * Transform::scale(3, 4, 5);
  scene.volumes[1].kind = GridFileDesc{folder / "colors.vol", true};
  scene.volumes[1].nearest = true;
  const auto lobe = [](float g, float weight) {
    return PhaseLobeDesc{PhaseLobeDesc::Kind::henyey_greenstein, Rgb(g), weight};
  };
  scene.media.resize(5);
  MediumDesc &milk = scene.media[0], &smoke = scene.media[1], &fog = scene.media[2];
  milk.id = "milk";
  milk.extinction.value = {3.1f, 0.5f, 7}, milk.albedo.value = {0.9f, 0.8f, 1};
  milk.phase = {lobe(-0.3f, 1)};
  smoke.extinction = {Rgb(2.7f), 0}, smoke.albedo = {Rgb(1), 1};
  smoke.phase = {lobe(0, 0.5f), lobe(0.6f, 0.25f), lobe(-0.6f, 0.25f)};
  fog.extinction.value = Rgb(0.1f), fog.albedo = {Rgb(1), 1};
  fog.phase = {lobe(0, 1)};
  scene.media[3].extinction = {Rgb(1), 0};
  scene.media[4].extinction.value = {0.1f, 0.2f, 0.3f};
  const auto shape = [&](int inside, int outside) {
    ShapeDesc& s = scene.shapes.emplace_back();
    s.kind = SphereDesc{}, s.bsdf = 0;
    s.media = {true, inside, outside};
  };
  shape(1, 0), shape(kNone, 2), shape(3, 3), shape(4, kNone);
  scene.shapes.emplace_back().kind = RectangleDesc{};
  scene.shapes.back().bsdf = 0;
  scene.sensors[0].medium = 2;

  const RoundTrip trip(scene, folder);
  EXPECT_EQ(listing(scene), listing(trip.again));
  EXPECT_EQ(trip.first.xml, trip.second.xml);
  EXPECT_EQ(all_warnings(trip.first), "");
  EXPECT_TRUE(trip.again.warnings.empty()) << trip.again.warnings[0].what;
  EXPECT_TRUE(trip.first.files.empty());
  EXPECT_EQ(trip.first.xml.find(folder / ""), std::string::npos) << "names are relative";
  EXPECT_EQ(trip.again.integrator, "volpathmis");
  EXPECT_EQ(trip.again.media[0].id, "milk");
  EXPECT_EQ(trip.again.volumes[0].id, "density");
  EXPECT_EQ(trip.again.media[0].extinction.value, milk.extinction.value) << "to the last digit";

  const std::string text = describe(trip.again);
  const std::string expected[] = {
      "2 volumes\n",
      "0 \"density\": grid " + (folder / "smoke.vol") + ", to_world [",
      ": grid " + (folder / "colors.vol") + ", in its own box, nearest\n",
      "5 media\n",
      "0 \"milk\": extinction (3.1, 0.5, 7), albedo (0.9, 0.8, 1), phase function hg -0.3\n",
      "extinction 2.7 × volume 0, albedo volume 1, phase function 0.5 of isotropic and 0.25 of hg 0.6 and "
      "0.25 of hg "
      "-0.6\n",
      "sphere at (0, 0, 0), radius 1, bsdf 0, inside medium 1, outside medium 0\n",
      "inside none, outside medium 2\n",
      ", in medium 2\n"};
  for (const std::string& line : expected)
    EXPECT_NE(text.find(line), std::string::npos) << line << " is not in\n" << text;
}

TEST(WrittenMedia, WhatIsNotOfMitsubaIsListedToo) {
  SceneDesc scene = cube_of_a_medium();
  const int grid = add_grid(scene, some_numbers({4, 3, 2}, 3), GridSampling::fading_cells);
  MediumDesc& m = scene.media[0];
  m.form = MediumDesc::Form::absorption_and_scattering;
  m.absorption.value = Rgb(0.5f), m.scattering = {{1, 2, 3}, grid}, m.emission.value = Rgb(4);
  m.phase = {{PhaseLobeDesc::Kind::schlick, {0.1f, 0.2f, 0.3f}, 1}};
  const std::string text = describe(scene);
  for (const char* line :
       {"  0: grid of 4 × 3 × 2 colors, box (-1, 0, 2) to (1, 4, 3), fading at the faces\n",
        "  0: absorption 0.5, scattering (1, 2, 3) × volume 0, emission 4, phase function schlick (0.1, 0.2, "
        "0.3)\n",
        "inside medium 0, outside none\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << " is not in\n" << text;
  EXPECT_EQ(describe(SceneDesc{}).find("media"), std::string::npos);
}

TEST(WrittenMedia, AbsorptionAndScatteringBecomeTheirSumAndItsAlbedo) {
  const auto written = [](VolumeInput absorption, VolumeInput scattering) {
    const test::TemporaryFolder folder;
    SceneDesc scene = cube_of_a_medium();
    add_grid(scene, some_numbers({2, 2, 2}, 1));
    scene.media[0].form = MediumDesc::Form::absorption_and_scattering;
    scene.media[0].absorption = absorption, scene.media[0].scattering = scattering;
    const RoundTrip trip(scene, folder);
    EXPECT_EQ(all_warnings(trip.first), "");
    EXPECT_EQ(trip.first.xml, trip.second.xml);
    return trip.again.media.at(0);
  };
  const Rgb a{1, 2, 0}, s{3, 2, 0};
  MediumDesc m = written({a}, {s});
  EXPECT_EQ(m.form, MediumDesc::Form::extinction_and_albedo);
  EXPECT_TRUE(m.homogeneous());
  EXPECT_EQ(m.extinction.value, (Rgb{4, 4, 0}));
  EXPECT_EQ(m.albedo.value, (Rgb{0.75f, 0.5f, 0}));
  m = written({Rgb(1), 0}, {Rgb(3), 0});
  EXPECT_EQ(m.extinction.volume, 0);
  EXPECT_EQ(m.extinction.value, Rgb(4));
  EXPECT_EQ(m.albedo.volume, kNone);
  EXPECT_EQ(m.albedo.value, Rgb(0.75f));
  m = written({Rgb(0)}, {Rgb(3), 0});
  EXPECT_EQ(m.extinction.volume, 0);
  EXPECT_EQ(m.extinction.value, Rgb(3));
  EXPECT_EQ(m.albedo.value, Rgb(1));
  m = written({Rgb(5), 0}, {Rgb(0)});
  EXPECT_EQ(m.extinction.value, Rgb(5));
  EXPECT_EQ(m.albedo.value, Rgb(0));
}

TEST(WrittenMedia, GridsInMemoryAreWrittenOnce) {
  const test::TemporaryFolder folder;
  SceneDesc scene = cube_of_a_medium();
  const int grid = add_grid(scene, some_numbers({4, 3, 2}, 1));
  scene.volumes[0].to_world = Transform::translate(1, 2, 3);
  scene.media[0].extinction.volume = grid;
  scene.media.push_back(scene.media[0]);
  const RoundTrip trip(scene, folder);
  ASSERT_EQ(trip.first.files.size(), 1u);
  EXPECT_EQ(trip.first.files[0].name, "out.volume_0.vol");
  ASSERT_EQ(trip.again.volumes.size(), 1u);
  EXPECT_EQ(trip.again.volumes[0].to_world, scene.volumes[0].to_world);
  EXPECT_TRUE(std::get<GridFileDesc>(trip.again.volumes[0].kind).use_grid_box);
  const GridData wanted = some_numbers({4, 3, 2}, 1);
  const test::TemporaryFolder other;
  std::ofstream(other / "a.vol", std::ios::binary) << trip.first.files[0].bytes;
  const GridData back = read_vol(other / "a.vol");
  EXPECT_EQ(back.values, wanted.values);
  EXPECT_EQ(back.lo, wanted.lo);
  EXPECT_EQ(back.hi, wanted.hi);
  // Where it is read from, it may not be written to.
  const auto files = files_of(trip.again);
  EXPECT_EQ(std::count(files.begin(), files.end(), folder / "out.volume_0.vol"), 1);
}

TEST(WrittenMedia, FactorsThatMitsubaHasNoPlaceForGoIntoTheNumbers) {
  const test::TemporaryFolder folder;
  SceneDesc scene = cube_of_a_medium();
  const GridData numbers = some_numbers({4, 3, 2}, 1);
  const int grid = add_grid(scene, numbers);
  const Rgb color{0.5f, 1, 2};
  scene.media[0].extinction = {color, grid}, scene.media[0].albedo = {Rgb(0.5f), grid};
  const RoundTrip trip(scene, folder);
  EXPECT_EQ(all_warnings(trip.first), "");
  ASSERT_EQ(trip.again.volumes.size(), 2u);
  const MediumDesc& m = trip.again.media.at(0);
  EXPECT_EQ(m.extinction.value, Rgb(1));
  const GridData colored = numbers_of(trip.again.volumes[0]), halved = numbers_of(trip.again.volumes[1]);
  EXPECT_EQ(colored.channels, 3);
  EXPECT_EQ(halved.channels, 1);
  for (std::size_t k = 0; k < numbers.values.size(); ++k) {
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(colored.values[3 * k + static_cast<std::size_t>(c)], numbers.values[k] * color[c]);
    EXPECT_EQ(halved.values[k], 0.5f * numbers.values[k]);
  }
}

// Mitsuba 3 reads files of 32-bit floats alone.
TEST(WrittenMedia, FilesOfBytesAreWrittenAnew) {
  for (const bool own_box : {false, true}) {
    const test::TemporaryFolder folder;
    std::string bytes = vol_bytes(some_numbers({2, 1, 1}, 1)).substr(0, 48);
    bytes[4] = 3;
    bytes += "\x33\xff";
    std::ofstream(folder / "bytes.vol", std::ios::binary) << bytes;
    SceneDesc scene = cube_of_a_medium();
    scene.volumes.emplace_back().kind = GridFileDesc{folder / "bytes.vol", own_box};
    scene.media[0].extinction.volume = 0;
    const RoundTrip trip(scene, folder);
    EXPECT_EQ(all_warnings(trip.first), "");
    ASSERT_EQ(trip.first.files.size(), 1u);
    const GridData back = numbers_of(trip.again.volumes.at(0));
    EXPECT_EQ(back.values, (std::vector<float>{0.2f, 1}));
    EXPECT_EQ(back.hi, (own_box ? Vec3f{1, 4, 3} : Vec3f{1, 1, 1}));
  }
}

// A sparse grid goes out as the dense one that it is in memory, where its file's transform has it.
TEST(WrittenMedia, SparseGridsAreWrittenAnew) {
  const test::TemporaryFolder folder;
  test_files::Grid sparse;
  sparse.voxels = {{{3, 0, 0}, 0.5f}, {{4, 0, 0}, 1}};
  sparse.to_file = Transform::translate(1, 2, 3) * Transform::scale(2, 2, 2);
  test_files::write_vdb(folder / "smoke.vdb", {sparse});
  for (const bool own_box : {true, false}) {
    SceneDesc scene = cube_of_a_medium();
    VolumeDesc& v = scene.volumes.emplace_back();
    v.sampling = GridSampling::corners, v.to_world = Transform::translate(10, 0, 0);
    v.kind = GridFileDesc{folder / "smoke.vdb", own_box};
    scene.volumes.push_back(v);
    scene.media[0].extinction.volume = 0;
    scene.media.push_back(scene.media[0]);
    scene.media[1].extinction.volume = 1;
    const RoundTrip trip(scene, folder);
    EXPECT_EQ(all_warnings(trip.first), "");
    ASSERT_FALSE(trip.first.files.empty());
    EXPECT_TRUE(trip.first.files[0].name.ends_with(".vol"));
    const VolumeDesc& back = trip.again.volumes.at(0);
    const GridData numbers = numbers_of(back);
    EXPECT_EQ(numbers.size, (std::array{4, 3, 3}));
    EXPECT_EQ(numbers.values.at((1 * 3 + 1) * 4 + 1), 0.5f);
    EXPECT_EQ(numbers.values.at((1 * 3 + 1) * 4 + 2), 1.0f);
    // In the middle of its cell is each number.
    Vec3d place;
    for (int axis = 0; axis < 3; ++axis)
      place[axis] = numbers.lo[axis] + (axis == 0 ? 2.5 : 1.5) /
                                           numbers.size[static_cast<std::size_t>(axis)] *
                                           (numbers.hi[axis] - numbers.lo[axis]);
    const Vec3f at = back.to_world.point(Vec3f(place)),
                wanted = own_box ? Vec3f{19, 2, 3} : Vec3f{10 + 2.0f / 3, 0.5f, 0.5f};
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(at[axis], wanted[axis], 1e-5f);
  }
}

TEST(WrittenMedia, WhatMitsubaLacksIsNamed) {
  const auto expect = [](const std::string& what, auto&& change) {
    const test::TemporaryFolder folder;
    SceneDesc scene = cube_of_a_medium();
    change(scene, scene.media[0]);
    const RoundTrip trip(scene, folder);
    const std::string warnings = all_warnings(trip.first);
    if (what.empty()) {
      EXPECT_EQ(warnings, "");
    } else {
      EXPECT_NE(warnings.find(what), std::string::npos) << what << " is not in: " << warnings;
    }
    EXPECT_EQ(all_warnings(trip.second), "");
    EXPECT_TRUE(trip.again.warnings.empty()) << trip.again.warnings[0].what;
    EXPECT_EQ(trip.again.media.size(), 1u);
    EXPECT_EQ(trip.again.shapes.at(0).media.inside, 0);
    return trip.again;
  };
  using Phase = PhaseLobeDesc::Kind;
  const auto g_of = [](const SceneDesc& scene) { return scene.media[0].phase.at(0).g; };
  expect("gives off", [](SceneDesc&, MediumDesc& m) { m.emission.value = Rgb(1); });
  EXPECT_EQ(g_of(expect("Schlick",
                        [](SceneDesc&, MediumDesc& m) {
                          m.phase = {{Phase::schlick, Rgb(0.5f), 1}};
                        })),
            Rgb(0.5f));
  expect("", [](SceneDesc&, MediumDesc& m) { m.phase = {{Phase::schlick, Rgb(0), 1}}; });
  EXPECT_NEAR(g_of(expect("each color",
                          [](SceneDesc&, MediumDesc& m) {
                            m.phase = {{Phase::henyey_greenstein, {0.1f, 0.2f, 0.6f}, 1}};
                          }))
                  .r,
              0.3f, 1e-6f);
  const auto two_grids = [](SceneDesc& scene, MediumDesc& m) {
    m.form = MediumDesc::Form::absorption_and_scattering;
    m.absorption.volume = add_grid(scene, some_numbers({3, 2, 2}, 1));
    m.absorption.value = Rgb(1);
    m.scattering.volume = add_grid(scene, some_numbers({3, 2, 2}, 1, 2));
  };
  expect("absorption beside", two_grids);
  expect("", [&](SceneDesc& scene, MediumDesc& m) {
    two_grids(scene, m);
    for (VolumeDesc& v : scene.volumes) v.nearest = true;
  });
  expect("the same places", [&](SceneDesc& scene, MediumDesc& m) {
    two_grids(scene, m);
    scene.volumes[0].to_world = Transform::scale(2, 1, 1);
  });

  const auto sampled = [](GridSampling sampling, bool albedo) {
    return [=](SceneDesc& scene, MediumDesc& m) {
      (albedo ? m.albedo : m.extinction).volume = add_grid(scene, some_numbers({3, 2, 1}, 1), sampling);
    };
  };
  expect("outermost numbers", sampled(GridSampling::corners, false));
  expect("faded to half", sampled(GridSampling::fading_cells, false));
  // What has no end can be larger.
  expect("", sampled(GridSampling::corners, true));
  expect("", sampled(GridSampling::centers, false));
  expect("", [&](SceneDesc& scene, MediumDesc& m) {
    sampled(GridSampling::fading_cells, false)(scene, m);
    scene.volumes[0].nearest = true;
  });
}

TEST(WrittenMedia, GridsOfOtherPlacesGiveWayToTheirMean) {
  const test::TemporaryFolder folder;
  SceneDesc scene = cube_of_a_medium();
  MediumDesc& m = scene.media[0];
  m.form = MediumDesc::Form::absorption_and_scattering;
  GridData absorption, scattering = some_numbers({3, 2, 2}, 1, 2);
  absorption.size = {2, 1, 1}, absorption.values = {1, 3};
  m.absorption = {Rgb(1), add_grid(scene, absorption)};
  m.scattering = {Rgb(1), add_grid(scene, scattering)};
  const RoundTrip trip(scene, folder);
  const GridData sum = numbers_of(trip.again.volumes.at(0)), albedo = numbers_of(trip.again.volumes.at(1));
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_EQ(sum.values.at(k), 2 + scattering.values[k]);
    EXPECT_EQ(albedo.values.at(k), scattering.values[k] / sum.values[k]);
  }
}

// A surface between empty space and empty space ends the medium that a ray has been in.
TEST(WrittenMedia, EmptySpaceOnBothSidesStaysADivision) {
  const test::TemporaryFolder folder;
  SceneDesc scene = cube_of_a_medium();
  scene.shapes[0].media = {true, kNone, kNone};
  const RoundTrip trip(scene, folder);
  const MediumInterfaceDesc media = trip.again.shapes.at(0).media;
  EXPECT_TRUE(media.divides);
  EXPECT_EQ(media.outside, kNone);
  ASSERT_NE(media.inside, kNone);
  EXPECT_EQ(trip.again.media.at(static_cast<std::size_t>(media.inside)).extinction.value, Rgb(0));
  EXPECT_EQ(all_warnings(trip.first), "");
}

}  // namespace
}  // namespace lumirank::scenedesc
