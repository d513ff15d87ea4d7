// Sparse grids in files of OpenVDB and NanoVDB: every voxel is where and what it was, and what cannot be read
// is refused by name.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/random.h"
#include "scenedesc/readers.h"
#include "scenedesc/volumes/grid_file.h"
#include "scenedesc/volumes/nanovdb_file.h"
#include "scenedesc/volumes/openvdb_file.h"
#include "sparse_files.h"
#include "support/refused.h"
#include "support/scene_file.h"

namespace lumirank::scenedesc {
namespace {

using test_files::Kind;
using test_files::Packing;
using test_files::write_nvdb;
using test_files::write_vdb;
using Sparse = test_files::Grid;

std::string bytes_of(const std::string& filename) {
  std::ifstream in(filename, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
void write_bytes(const std::string& filename, const std::string& bytes) {
  std::ofstream(filename, std::ios::binary) << bytes;
}

// Leaves on both sides of 0 and far away.
Sparse smoke(Kind kind = Kind::f32) {
  Sparse grid;
  grid.kind = kind;
  grid.voxels = {
      {{-3, 5, 9}, 0.5f}, {{-2, 5, 9}, 0.25f}, {{11, 17, -20}, 2}, {{-9, 0, 0}, 1}, {{40, 2, 1}, 0.125f}};
  return grid;
}

// The number of a voxel, by the transform: the grid's own index is what the file's transform is undone to.
float number_at(const GridFile& file, const Sparse& grid, std::array<int, 3> voxel, int channel = 0) {
  const Vec3d place = grid.to_file.place({double(voxel[0]), double(voxel[1]), double(voxel[2])});
  const Vec3d at = file.to_file.inverse()->place(place);
  std::array<std::size_t, 3> k{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    EXPECT_NEAR(at[axis], std::round(at[axis]), 1e-6);
    if (at[axis] < -0.5 || at[axis] > file.numbers.size[i] - 0.5) {
      ADD_FAILURE() << "a voxel is beyond the box";
      return NAN;
    }
    k[i] = static_cast<std::size_t>(std::lround(at[axis]));
  }
  const auto& size = file.numbers.size;
  return file.numbers.values.at(
      ((k[2] * static_cast<std::size_t>(size[1]) + k[1]) * static_cast<std::size_t>(size[0]) + k[0]) *
          static_cast<std::size_t>(file.numbers.channels) +
      static_cast<std::size_t>(channel));
}

void expect_smoke(const GridFile& file, const Sparse& grid, float tolerance = 0) {
  const int channels = grid.kind == Kind::color || grid.kind == Kind::color64 ? 3 : 1;
  EXPECT_EQ(file.numbers.channels, channels);
  // From -9 to 40, 0 to 17, -20 to 9, and one more on all sides.
  EXPECT_EQ(file.numbers.size, (std::array{52, 20, 32}));
  EXPECT_EQ(file.numbers.lo, (Vec3f{0, 0, 0}));
  EXPECT_EQ(file.numbers.hi, (Vec3f{51, 19, 31}));
  double sum = 0, wanted = 0;
  for (const float value : file.numbers.values) sum += static_cast<double>(value);
  for (const auto& voxel : grid.voxels)
    for (int c = 0; c < channels; ++c) {
      EXPECT_NEAR(number_at(file, grid, voxel.at, c), voxel.value * static_cast<float>(c + 1), tolerance);
      wanted += static_cast<double>(voxel.value) * (c + 1);
    }
  EXPECT_NEAR(sum, wanted, static_cast<double>(tolerance) * 1000);  // there is nothing else
  EXPECT_EQ(file.too_fine, "");
}

Transform leaning() {
  Transform out;
  out.m = {0.5, 0.1, 0, 3, 0, 0.25, -0.1, 1e6, 0.2, 0, 2, -7, 0, 0, 0, 1};
  return out;
}

TEST(SparseFiles, EveryVoxelIsWhereItWas) {
  const test::TemporaryFolder folder;
  for (const Transform& to_file :
       {Transform{}, Transform::translate(1, 2, 3) * Transform::scale(0.5, 0.5, 0.5), leaning()}) {
    for (const Kind kind : {Kind::f32, Kind::half, Kind::f64, Kind::color, Kind::color64}) {
      Sparse grid = smoke(kind);
      grid.to_file = to_file;
      write_vdb(folder / "a.vdb", {grid});
      expect_smoke(read_grid_file({folder / "a.vdb", true}), grid);
    }
    for (const Kind kind : {Kind::f32, Kind::f64, Kind::color}) {
      Sparse grid = smoke(kind);
      grid.to_file = to_file;
      write_nvdb(folder / "a.nvdb", {grid});
      expect_smoke(read_grid_file({folder / "a.nvdb", true}), grid);
      write_nvdb(folder / "a.nvdb", {grid}, Packing::zip);
      expect_smoke(read_grid_file({folder / "a.nvdb", true}), grid);
    }
  }
}

TEST(SparseFiles, PackedNumbers) {
  const test::TemporaryFolder folder;
  const std::pair<Kind, float> kinds[] = {
      {Kind::fp16, 2e-5f}, {Kind::fp8, 0.005f}, {Kind::fp4, 0.07f}, {Kind::fpn, 0.07f}};
  for (const auto& [kind, tolerance] : kinds) {
    Sparse grid = smoke(kind);
    // Numbers of all sizes within a leaf.
    for (int k = 0; k < 64; ++k)
      grid.voxels.push_back({{16 + k % 4, 8 + k / 4 % 4, k / 16}, static_cast<float>(k) / 64});
    write_nvdb(folder / "a.nvdb", {grid});
    const GridFile file = read_grid_file({folder / "a.nvdb", true});
    for (const auto& voxel : grid.voxels)
      EXPECT_NEAR(number_at(file, grid, voxel.at), voxel.value, tolerance) << static_cast<int>(kind);
  }
}

// What a file says in one number for a cube of 8, 128 or 4096 voxels.
TEST(SparseFiles, CubesOfOneValue) {
  const test::TemporaryFolder folder;
  Sparse grid;
  grid.first = {-8, -8, -8}, grid.last = {23, 7, 15}, grid.value = 0.75f;
  grid.voxels = {{{30, 0, 0}, 0.5f}, {{-8, -8, -8}, 0.25f}};
  write_vdb(folder / "a.vdb", {grid});
  write_nvdb(folder / "a.nvdb", {grid});
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    const GridFile file = read_grid_file({folder / name, true});
    EXPECT_EQ(file.numbers.size, (std::array{41, 18, 26})) << name;
    EXPECT_EQ(number_at(file, grid, {-8, -8, -8}), 0.25f);
    EXPECT_EQ(number_at(file, grid, {-7, -8, -8}), 0.75f);
    EXPECT_EQ(number_at(file, grid, {23, 7, 15}), 0.75f);
    EXPECT_EQ(number_at(file, grid, {24, 7, 15}), 0);
    EXPECT_EQ(number_at(file, grid, {30, 0, 0}), 0.5f);
    EXPECT_EQ(number_at(file, grid, {-9, 0, 0}), 0) << "the background is all around";
  }
}

TEST(SparseFiles, TheBackgroundIsWhatIsNotThere) {
  const test::TemporaryFolder folder;
  Sparse grid;
  grid.background = 20, grid.voxels = {{{0, 0, 0}, 900}, {{2, 0, 0}, 800}};
  write_vdb(folder / "a.vdb", {grid});
  write_nvdb(folder / "a.nvdb", {grid});
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    const GridFile file = read_grid_file({folder / name, true});
    EXPECT_EQ(number_at(file, grid, {0, 0, 0}), 900);
    EXPECT_EQ(number_at(file, grid, {1, 0, 0}), 20);
    EXPECT_EQ(number_at(file, grid, {2, 1, 0}), 20);
  }
}

TEST(SparseFiles, AGridWithoutVoxelsIsEmptySpace) {
  const test::TemporaryFolder folder;
  write_vdb(folder / "a.vdb", {Sparse{}});
  write_nvdb(folder / "a.nvdb", {Sparse{}});
  for (const char* name : {"a.vdb", "a.nvdb"})
    EXPECT_EQ(read_grid_file({folder / name, true}).numbers.values, std::vector<float>(27)) << name;
}

// Too many voxels become fewer: the mean of 2 × 2 × 2 of them, in their middle.
TEST(SparseFiles, WhatIsTooLargeIsTakenCoarser) {
  const test::TemporaryFolder folder;
  Sparse grid;
  grid.first = {0, 0, 0}, grid.last = {15, 15, 15}, grid.value = 1;
  grid.voxels = {{{0, 0, 0}, 9}, {{16, 0, 0}, 4}};  // 17 × 16 × 16
  write_vdb(folder / "a.vdb", {grid});
  write_nvdb(folder / "a.nvdb", {grid});
  for (const bool nano : {false, true}) {
    const std::string name = folder / (nano ? "a.nvdb" : "a.vdb");
    const auto read = [&](std::uint64_t most) {
      return nano ? parse_nanovdb(bytes_of(name), name, "", most) : read_openvdb(name, "", most);
    };
    EXPECT_EQ(read(19 * 18 * 18).numbers.size, (std::array{19, 18, 18}));
    const GridFile half = read(19 * 18 * 18 - 1);
    EXPECT_EQ(half.numbers.size, (std::array{11, 10, 10}));
    const auto at = [&](std::size_t x, std::size_t y, std::size_t z) {
      return half.numbers.values.at((z * 10 + y) * 11 + x);
    };
    EXPECT_FLOAT_EQ(at(1, 1, 1), 2);
    EXPECT_FLOAT_EQ(at(2, 1, 1), 1);
    EXPECT_FLOAT_EQ(at(9, 1, 1), 0.5f) << "a voxel of eight";
    EXPECT_EQ(at(0, 1, 1), 0);
    EXPECT_EQ(half.to_file.place({1, 1, 1}), (Vec3d{0.5, 0.5, 0.5}));
    EXPECT_EQ(half.to_file.place({2, 1, 1}), (Vec3d{2.5, 0.5, 0.5}));
    EXPECT_NE(half.too_fine.find("17 × 16 × 16 voxels"), std::string::npos) << half.too_fine;
    EXPECT_NE(half.coarser.find("2 × 2 × 2"), std::string::npos) << half.coarser;
    const std::string error = test::refused([&] { read(50); });
    EXPECT_NE(error.find("17 × 16 × 16 voxels"), std::string::npos) << error;
    EXPECT_NE(error.find("resample"), std::string::npos) << error;
  }
}

TEST(SparseFiles, OneOfSeveralGrids) {
  const test::TemporaryFolder folder;
  Sparse heat, density = smoke();
  heat.name = "heat", heat.voxels = {{{0, 0, 0}, 7}};
  for (const char* name : {"a.vdb", "stream.vdb", "a.nvdb"}) {
    const std::string file = folder / name;
    if (file.ends_with(".nvdb"))
      write_nvdb(file, {heat, density});
    else
      write_vdb(file, {heat, density}, std::string(name) == "stream.vdb");
    EXPECT_EQ(grid_names(file), (std::vector<std::string>{"heat", "density"})) << name;
    expect_smoke(read_grid_file({file, true}), density);
    expect_smoke(read_grid_file({file, true, "density"}), density);
    EXPECT_EQ(number_at(read_grid_file({file, true, "heat"}), heat, {0, 0, 0}), 7);
    const std::string error = test::refused([&] { read_grid_file({file, true, "Heat"}); });
    for (const char* says : {name, "no grid \"Heat\"", "\"heat\", \"density\""})
      EXPECT_NE(error.find(says), std::string::npos) << says << " is not in: " << error;
  }
  // The only one needs no name, one of several does.
  write_vdb(folder / "a.vdb", {heat});
  write_nvdb(folder / "a.nvdb", {heat});
  for (const char* name : {"a.vdb", "a.nvdb"})
    EXPECT_EQ(number_at(read_grid_file({folder / name, true}), heat, {0, 0, 0}), 7) << name;
  Sparse other = heat;
  other.name = "cold";
  write_vdb(folder / "a.vdb", {heat, other});
  EXPECT_NE(test::refused([&] {
              read_grid_file({folder / "a.vdb", true});
            }).find("no grid \"density\""),
            std::string::npos);
  // The tree of another, in a place of its own.
  other.shares_with = "heat", other.to_file = Transform::scale(2, 2, 2);
  write_vdb(folder / "a.vdb", {heat, other});
  EXPECT_EQ(number_at(read_grid_file({folder / "a.vdb", true, "cold"}), other, {0, 0, 0}), 7);
}

TEST(SparseFiles, TheirFirstBytesSayWhatTheyAre) {
  const test::TemporaryFolder folder;
  const Sparse grid = smoke();
  write_vdb(folder / "a.nvdb", {grid});
  write_nvdb(folder / "a.VDB", {grid});
  expect_smoke(read_grid_file({folder / "a.nvdb", true}), grid);
  expect_smoke(read_grid_file({folder / "a.VDB", true}), grid);
}

TEST(SparseFiles, WhatCannotBeReadIsRefusedByName) {
  const test::TemporaryFolder folder;
  const auto expect = [&](const std::string& name, const std::string& says, const std::string& remedy) {
    const std::string error = test::refused([&] { read_grid_file({folder / name, true}); });
    for (const std::string& part : {name, says, remedy})
      EXPECT_NE(error.find(part), std::string::npos) << part << " is not in: " << error;
  };
  expect("none.vdb", "not found", "check the name");
  std::filesystem::create_directory(folder / "folder.nvdb");
  expect("folder.nvdb", "folder", "check the name");
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    write_bytes(folder / name, "");
    expect(name, "is empty", "export");
    write_bytes(folder / name, "VOL\3 and so on");
    expect(name, "neither", "export");
    write_bytes(folder / name, "NanoV");
    expect(name, "neither", "export");
  }
  Sparse grid = smoke();
  for (const Kind kind : {Kind::whole}) {
    grid.kind = kind;
    write_vdb(folder / "a.vdb", {grid});
    expect("a.vdb", "\"density\" is one of type int32", "floats");
    write_nvdb(folder / "a.nvdb", {grid});
    expect("a.nvdb", "\"density\" is one of type int32", "floats");
  }
  grid.kind = Kind::f32, grid.level_set = true;
  write_vdb(folder / "a.vdb", {grid});
  write_nvdb(folder / "a.nvdb", {grid});
  for (const char* name : {"a.vdb", "a.nvdb"}) expect(name, "level set", "fog volume");
  grid.level_set = false, grid.frustum = true;
  write_vdb(folder / "a.vdb", {grid});
  expect("a.vdb", "frustum", "resample");
  grid.frustum = false;
  for (const float number : {NAN, INFINITY}) {
    grid.voxels[0].value = number;
    write_vdb(folder / "a.vdb", {grid});
    write_nvdb(folder / "a.nvdb", {grid});
    for (const char* name : {"a.vdb", "a.nvdb"}) expect(name, "not finite", "export");
  }
}

TEST(SparseFiles, NanoVdbThatIsNotForUs) {
  const test::TemporaryFolder folder;
  write_nvdb(folder / "a.nvdb", {smoke()});
  const std::string good = bytes_of(folder / "a.nvdb");
  const auto expect = [&](const std::string& bytes, const std::string& says, const std::string& remedy) {
    const std::string error = test::refused([&] { parse_nanovdb(bytes, "a.nvdb", ""); });
    for (const std::string& part : {std::string("a.nvdb"), says, remedy})
      EXPECT_NE(error.find(part), std::string::npos) << part << " is not in: " << error;
  };
  const auto changed = [&](std::size_t at, char byte) {
    std::string bytes = good;
    bytes[at] = byte;
    return bytes;
  };
  EXPECT_EQ(parse_nanovdb(changed(7, '2'), "a.nvdb", "").numbers.values,
            parse_nanovdb(good, "a.nvdb", "").numbers.values);
  expect(changed(7, '1'), "as it lies in memory", "writeGrid");
  expect(changed(11, 5), "version 40", "nanovdb_convert");
  expect(changed(14, 2), "Blosc", "zip");
  expect(changed(14, 9), "method 9", "zip");
  expect(changed(14, 1), "", "export");  // what follows is no compressed grid
  expect(good + "and more", "something else", "export");
  expect("", "empty", "export");
  // Cut off anywhere.
  Rng rng(1, Stage::test);
  for (int k = 0; k < 200; ++k) {
    const std::string error = test::refused([&] {
      parse_nanovdb(good.substr(0, 1 + rng.next_below(static_cast<std::uint32_t>(good.size() - 1))), "a.nvdb",
                    "");
    });
    EXPECT_NE(error.find("a.nvdb"), std::string::npos) << error;
  }
}

TEST(SparseFiles, OpenVdbThatIsCutOff) {
  const test::TemporaryFolder folder;
  Sparse heat = smoke();
  heat.name = "heat";
  for (const bool as_stream : {false, true}) {
    write_vdb(folder / "a.vdb", {smoke(), heat}, as_stream);
    const std::string good = bytes_of(folder / "a.vdb");
    Rng rng(2, Stage::test);
    for (int k = 0; k < 100; ++k) {
      write_bytes(folder / "cut.vdb",
                  good.substr(0, 8 + rng.next_below(static_cast<std::uint32_t>(good.size() - 8))));
      const std::string error = test::refused([&] { read_grid_file({folder / "cut.vdb", true, "heat"}); });
      EXPECT_NE(error.find("cut.vdb"), std::string::npos) << error;
      EXPECT_NE(error.find("export it again"), std::string::npos) << error;
    }
  }
}

// Changed in some bytes, a file is read or refused.
TEST(SparseFiles, DamageIsNoHarm) {
  const test::TemporaryFolder folder;
  for (const Kind kind : {Kind::f32, Kind::f64, Kind::color, Kind::fp8, Kind::fpn}) {
    write_nvdb(folder / "a.nvdb", {smoke(kind)});
    const std::string good = bytes_of(folder / "a.nvdb");
    Rng rng(3, Stage::test);
    int refused = 0;
    for (int k = 0; k < 300; ++k) {
      std::string bytes = good;
      // Most of a file is empty nodes: what refers to others is in the first bytes of nodes.
      for (int change = 0; change < 4; ++change) {
        const std::size_t end =
            rng.next_float() < 0.5f ? std::min<std::size_t>(bytes.size(), 1400) : bytes.size();
        bytes[rng.next_below(static_cast<std::uint32_t>(end))] = static_cast<char>(rng.next_below(256));
      }
      try {
        const GridFile file = parse_nanovdb(bytes, "a.nvdb", "", 1 << 16);
        std::size_t count = static_cast<std::size_t>(file.numbers.channels);
        for (const int places : file.numbers.size) count *= static_cast<std::size_t>(places);
        EXPECT_EQ(file.numbers.values.size(), count);
      } catch (const InputError&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 20);
  }
}

// Mitsuba has no such volumes; a gridvolume takes them all the same.
TEST(SparseFiles, AreVolumesOfMitsubaScenes) {
  const test::TemporaryFolder folder;
  write_vdb(folder / "smoke.vdb", {smoke()});
  const auto read = [&](const std::string& version, const std::string& more) {
    return parse_mitsuba("<scene version=\"" + version +
                             "\"><sensor type=\"perspective\"/><shape type=\"cube\"><medium "
                             "name=\"interior\" type=\"heterogeneous\">"
                             "<volume type=\"gridvolume\" name=\"" +
                             (version[0] == '0' ? "density" : "sigma_t") +
                             "\"><string name=\"filename\" value=\"smoke.vdb\"/>" + more +
                             "</volume></medium></shape></scene>",
                         folder / "scene.xml");
  };
  for (const char* version : {"0.6.0", "3.0.0"}) {
    const SceneDesc scene = read(version, "<string name=\"grid\" value=\"heat\"/>");
    EXPECT_TRUE(scene.warnings.empty()) << describe(scene);
    const VolumeDesc& volume = scene.volumes.at(0);
    EXPECT_EQ(volume.sampling, GridSampling::corners);
    const auto& file = std::get<GridFileDesc>(volume.kind);
    EXPECT_EQ(file.filename, folder / "smoke.vdb");
    EXPECT_EQ(file.grid, "heat");
    EXPECT_TRUE(file.use_grid_box);
  }
  const SceneDesc scene = read("3.0.0", "<boolean name=\"use_grid_bbox\" value=\"false\"/>");
  EXPECT_FALSE(std::get<GridFileDesc>(scene.volumes.at(0).kind).use_grid_box);
  EXPECT_EQ(std::get<GridFileDesc>(scene.volumes.at(0).kind).grid, "");
}

}  // namespace
}  // namespace lumirank::scenedesc
