// pbrt's media in files of sparse grids, what glows in them, and clouds.
#include <cmath>

#include "base/spectrum.h"
#include "scenedesc/pbrt/perlin_noise.h"
#include "scenedesc/pbrt_scene.h"
#include "sparse_files.h"
#include "support/refused.h"
#include "support/scene_file.h"

namespace lumirank::scenedesc {
namespace {

using test_files::write_nvdb;
using test_files::write_vdb;
using Sparse = test_files::Grid;

std::string nanovdb_text(const std::string& file, const std::string& parameters = "") {
  return "MakeNamedMedium \"smoke\" \"string type\" \"nanovdb\" \"string filename\" \"" + file + "\" " +
         parameters + "\n";
}

Sparse some_density() {
  Sparse grid;
  grid.voxels = {{{4, 0, 0}, 1}, {{5, 0, 0}, 2}, {{6, 0, 0}, 4}};
  grid.to_file = Transform::scale(0.5, 0.5, 0.5);
  return grid;
}

TEST(PbrtSparseMedium, IsAbsorptionAndScatteringTimesAGrid) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "smoke.nvdb";
  write_nvdb(file, {some_density()});
  const SceneDesc scene = pbrt_world(
      "Translate 10 0 0\n" + nanovdb_text(file,
                                          "\"rgb sigma_a\" [ .5 .5 .5 ] \"rgb sigma_s\" [ 2 3 4 ] \"float "
                                          "scale\" 2 \"float g\" .25"));
  EXPECT_TRUE(scene.warnings.empty()) << describe(scene);
  const MediumDesc& m = scene.media.at(0);
  EXPECT_EQ(m.absorption.value, Rgb(1));
  EXPECT_EQ(m.scattering.value, Rgb(4, 6, 8));
  EXPECT_EQ(m.absorption.volume, m.scattering.volume);
  EXPECT_EQ(m.emission.volume, kNone);
  EXPECT_EQ(m.phase.at(0).g, Rgb(0.25f));
  const VolumeDesc& v = volume(scene, m.scattering);
  EXPECT_EQ(v.to_world.point({0, 0, 0}), (Vec3f{10, 0, 0}));
  EXPECT_EQ(v.sampling, GridSampling::corners);
  const auto& desc = std::get<GridFileDesc>(v.kind);
  EXPECT_EQ(desc.filename, file);
  EXPECT_EQ(desc.grid, "density");
  EXPECT_TRUE(desc.use_grid_box);
  EXPECT_NE(describe(scene).find("grid \"density\" of " + file + ", in its own box, to_world"),
            std::string::npos)
      << describe(scene);
}

TEST(PbrtSparseMedium, GridsHaveNames) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "smoke.vdb";
  Sparse grid = some_density();
  grid.name = "soot";
  write_vdb(file, {grid});
  const SceneDesc scene = pbrt_world(nanovdb_text(file, "\"string gridname\" \"soot\""));
  EXPECT_EQ(std::get<GridFileDesc>(volume(scene, scene.media.at(0).scattering).kind).grid, "soot");
}

TEST(PbrtSparseMedium, MovesByNumberedFiles) {
  const test::TemporaryFolder folder;
  for (const char* name : {"puff.10.nvdb", "puff.11.nvdb"}) write_nvdb(folder / name, {some_density()});
  ReadOptions options;
  options.frames_per_second = 10, options.time = 1.1;
  const SceneDesc scene = pbrt_world(nanovdb_text(folder / "puff.##.nvdb"), "", options);
  const auto& grid = std::get<GridFileDesc>(volume(scene, scene.media.at(0).scattering).kind);
  EXPECT_EQ(grid.filename, folder / "puff.11.nvdb");
  EXPECT_EQ(grid.sequence.size(), 2u);
  EXPECT_NEAR(scene.motion.begin, 1, 1e-12);
  EXPECT_NEAR(scene.motion.end, 1.1, 1e-12);
}

TEST(PbrtSparseMedium, GlowsWithItsTemperature) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "fire.nvdb";
  // The temperature of voxels of half the size: what is beyond its own box is the background.
  Sparse heat;
  heat.name = "temperature", heat.to_file = Transform::scale(0.25, 0.25, 0.25);
  heat.voxels = {{{8, 0, 0}, 30}, {{9, 0, 0}, 99}, {{10, 0, 0}, 15}, {{12, 0, 0}, 1}};
  write_nvdb(file, {some_density(), heat});
  const SceneDesc scene = pbrt_world(nanovdb_text(file,
                                                  "\"rgb sigma_a\" [ 2 2 2 ] \"float Lescale\" 3 \"float "
                                                  "temperaturescale\" 100 \"float temperatureoffset\" -1"));
  const MediumDesc& m = scene.media.at(0);
  EXPECT_EQ(m.absorption.value, Rgb(2));
  EXPECT_NEAR(m.emission.value.r, 6 * 106.856895f, 1e-2f);
  const VolumeDesc& v = volume(scene, m.emission);
  const GridData& grid = *std::get<std::shared_ptr<const GridData>>(v.kind);
  EXPECT_EQ(grid.size, (std::array{5, 3, 3}));
  EXPECT_EQ(grid.channels, 3);
  // Of the density's numbers the first is one voxel before it.
  EXPECT_EQ(v.to_world.point(grid.lo), (Vec3f{1.5f, -0.5f, -0.5f}));
  EXPECT_EQ(v.to_world.point(grid.hi), (Vec3f{3.5f, 0.5f, 0.5f}));
  const auto at = [&](std::size_t x) {
    const std::size_t k = 3 * ((1 * 3 + 1) * 5 + x);
    return Rgb{grid.values.at(k), grid.values[k + 1], grid.values[k + 2]};
  };
  const auto expected = [](float density, float kelvin) {
    // pbrt's spectrum is 1 where it is largest.
    const double peak = planck(2.897771955e6 / static_cast<double>(kelvin), static_cast<double>(kelvin));
    Rgb out = blackbody_to_rgb(kelvin) * static_cast<float>(static_cast<double>(density) / peak);
    for (int c = 0; c < 3; ++c) out[c] = std::max(out[c], 0.0f);
    return out;
  };
  EXPECT_EQ(at(0), Rgb(0));
  expect_near(at(1), expected(1, 3100), 1e-4f);
  expect_near(at(2), expected(2, 1600), 1e-4f);
  expect_near(at(3), expected(4, 200), 1e-6f);
  EXPECT_EQ(at(4), Rgb(0));
  // By its other name, and what does not absorb, or is told not to, is dark.
  const std::string old = "\"float temperaturecutoff\" 1e5";
  for (const std::string& dark :
       {old, std::string("\"float Lescale\" 0"), std::string("\"rgb sigma_a\" [ 0 0 0 ]"),
        std::string("\"string temperaturename\" \"none\"")})
    EXPECT_EQ(pbrt_world(nanovdb_text(file, dark)).media.at(0).emission.volume, kNone) << dark;
}

TEST(PbrtSparseMedium, WhatIsWrongIsRefused) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "smoke.nvdb";
  const auto expect = [](const std::string& text, const std::string& says) {
    const std::string error = test::refused([&] { pbrt_world(text); });
    EXPECT_NE(error.find(says), std::string::npos) << says << " is not in: " << error;
  };
  expect(nanovdb_text(file), "not found");
  expect("MakeNamedMedium \"smoke\" \"string type\" \"nanovdb\"\n", "filename");
  std::ofstream(file) << "no grid";
  expect(nanovdb_text(file), "neither");
  std::ofstream(folder / "smoke.vol") << "VOL";
  expect(nanovdb_text(folder / "smoke.vol"), ".nvdb and .vdb");
  Sparse colors = some_density(), heat = some_density();
  heat.name = "temperature", heat.voxels[0].value = 1000, colors.kind = test_files::Kind::color;
  write_nvdb(file, {colors, heat});
  expect(nanovdb_text(file), "three channels");
  expect("Scale 1 0 1\n" + nanovdb_text(file), "singular");
  ReadOptions options;
  options.allow_missing = true;
  const SceneDesc scene = pbrt_world(nanovdb_text(folder / "none.nvdb"), "", options);
  EXPECT_EQ(only_warning(scene).used_instead, "empty space");
  EXPECT_TRUE(scene.media.empty());
}

// Numbers of the formula in double precision, evaluated apart.
TEST(PerlinNoise, IsThatOfPbrt) {
  const std::pair<Vec3f, float> known[] = {{{0.25f, 0.5f, 0.75f}, -0.06879425f},
                                           {{-1.5f, 2.25f, 3.125f}, -0.30144570f},
                                           {{100.5f, -200.25f, 7.875f}, 0.02757332f},
                                           {{255.5f, 255.5f, 255.5f}, -0.375f},
                                           {{12, 0.5f, 0.25f}, 0.11206055f}};
  for (const auto& [place, noise] : known) {
    EXPECT_NEAR(pbrt::perlin_noise(place), noise, 1e-6f);
    EXPECT_NEAR(pbrt::perlin_noise(place + Vec3f{256, -512, 768}), noise, 1e-6f) << "it repeats";
  }
  for (const Vec3f whole : {Vec3f{0, 0, 0}, Vec3f{3, -7, 255}, Vec3f{1000, 2, -1e6f}})
    EXPECT_EQ(pbrt::perlin_noise(whole), 0);
  EXPECT_NEAR(pbrt::perlin_slope({0.25f, 0.5f, 0.75f}).x, (-0.07126377f + 0.06879425f) / 0.01f, 1e-4f);
  EXPECT_EQ(pbrt::perlin_noise({kInfinity, 0, 0}), 0);
}

TEST(PbrtCloud, IsADensityOnAGrid) {
  const std::string parameters =
      "\"string type\" \"cloud\" \"float density\" 2 \"float wispiness\" 0 \"float frequency\" 3 \"point3 "
      "p0\" [ 0 0 0 ] "
      "\"point3 p1\" [ 2 1 .25 ] \"rgb sigma_a\" [ 0 0 0 ] \"rgb sigma_s\" [ 4 4 4 ] \"float g\" .5";
  const SceneDesc scene = pbrt_world("Translate 1 0 0\nMakeNamedMedium \"c\" " + parameters + "\n");
  const Warning warning = only_warning(scene);
  EXPECT_EQ(warning.where.line, 4);
  EXPECT_NE(warning.used_instead.find("189 × 95 × 32"), std::string::npos) << warning.used_instead;
  const MediumDesc& m = scene.media.at(0);
  EXPECT_EQ(m.scattering.value, Rgb(4));
  EXPECT_EQ(m.scattering.volume, m.absorption.volume);
  EXPECT_EQ(m.phase.at(0).g, Rgb(0.5f));
  const VolumeDesc& v = volume(scene, m.scattering);
  EXPECT_EQ(v.to_world.point({0, 0, 0}), (Vec3f{1, 0, 0}));
  EXPECT_EQ(v.to_world.point({1, 1, 1}), (Vec3f{3, 1, 0.25f}));
  const GridData& grid = *std::get<std::shared_ptr<const GridData>>(v.kind);
  // At the ground it is thick; above, what pbrt's formula says.
  EXPECT_EQ(grid.values.at(0), std::min(1.0f, grid.values[0]));
  const auto at = [&](std::size_t x, std::size_t y, std::size_t z) {
    return grid.values.at((z * 95 + y) * 189 + x);
  };
  EXPECT_NEAR(at(5, 20, 3), 1, 0.5f);
  for (const auto& [x, y, z] : {std::array<std::size_t, 3>{100, 60, 7}, {33, 70, 20}, {150, 50, 0}}) {
    const Vec3f place{2 * (static_cast<float>(x) + 0.5f) / 189, (static_cast<float>(y) + 0.5f) / 95,
                      0.25f * (static_cast<float>(z) + 0.5f) / 32};
    float noise = 0, size = 0.5f, finer = 3;
    for (int k = 0; k < 5; ++k, size /= 2, finer *= 1.99f) noise += size * pbrt::perlin_noise(place * finer);
    EXPECT_NEAR(at(x, y, z), std::clamp((1 - place.y) * 9 * noise, 0.0f, 1.0f), 1e-3f);
  }
  EXPECT_NE(pbrt_world("MakeNamedMedium \"c\" \"string type\" \"cloud\" \"float frequency\" .5\n")
                .media.at(0)
                .scattering.volume,
            kNone);
  EXPECT_NE(test::refused([] {
              pbrt_world("MakeNamedMedium \"c\" \"string type\" \"cloud\" \"float frequency\" 0\n");
            }).find("frequency"),
            std::string::npos);
}

}  // namespace
}  // namespace lumirank::scenedesc
