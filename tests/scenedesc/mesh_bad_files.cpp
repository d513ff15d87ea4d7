// A corpus of bad mesh files: each is refused with its name, the line where it is text, and what is wrong.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "base/error.h"
#include "base/random.h"
#include "mesh_builders.h"
#include "scenedesc/bad_files.h"
#include "scenedesc/readers.h"

namespace lumirank::scenedesc {
namespace {

const BadFile kBadMeshes[] = {
    {"index_out_of_range.obj", 4, "vertex 4"},
    {"index_zero.obj", 5, "vertex 0"},
    {"index_before_first.obj", 4, "vertex -4"},
    {"huge_index.obj", 4, "not a face index"},
    {"uv_out_of_range.obj", 5, "texture coordinate 2"},
    {"normal_out_of_range.obj", 4, "normal 1"},
    {"nan.obj", 2, "not finite"},
    {"infinite.obj", 2, "not finite"},
    {"short_vertex.obj", 2, "too few"},
    {"word_for_number.obj", 1, "'zero'"},
    {"trailing.obj", 4, "'x'"},
    {"continued_line.obj", 5, "'bad'"},
    {"binary.obj", 1, "text"},
    {"empty.ply", 1, "does not end"},
    {"wrong_magic.ply", 1, "not a PLY"},
    {"unended_header.ply", 4, "does not end"},
    {"no_format.ply", 3, "no format"},
    {"unknown_format.ply", 2, "binary_middle_endian"},
    {"unknown_type.ply", 4, "quad"},
    {"unknown_keyword.ply", 3, "elephant"},
    {"negative_count.ply", 3, "count"},
    {"overflowing_count.ply", 3, "count"},
    {"float_list_length.ply", 4, "integer"},
    {"property_first.ply", 3, "before any element"},
    {"no_xyz.ply", 0, "x, y and z"},
    {"no_indices.ply", 10, "vertex_indices"},
    {"vertices_twice.ply", 14, "twice"},
    {"truncated_ascii.ply", 14, "file"},
    {"index_out_of_range.ply", 14, "no vertex 3"},
    {"negative_index.ply", 13, "no vertex -1"},
    {"nan_ascii.ply", 11, "not finite"},
    {"word_ascii.ply", 11, "'x'"},
    {"list_too_long.ply", 13, "within a list"},
    {"huge_count_ascii.ply", 10, "too short"},
    {"huge_count_binary.ply", 0, "too short"},
    {"huge_faces_binary.ply", 0, "too short"},
    {"truncated_vertices.ply", 0, "too short"},
    {"truncated_faces.ply", 0, "within a list"},
    {"nan_binary.ply", 0, "'vertex' 1: the position is not finite"},
    {"wrong_endian.ply", 0, "no vertex"},
    {"empty.serialized", 0, "too short"},
    {"wrong_magic.serialized", 0, "magic"},
    {"wrong_version.serialized", 0, "version 7"},
    {"huge_table.serialized", 0, "table"},
    {"no_mesh.serialized", 0, "table"},
    {"offset_out_of_range.serialized", 0, "offset"},
    {"offset_overflows.serialized", 0, "offset"},
    {"garbage_stream.serialized", 0, "compressed"},
    {"truncated_stream.serialized", 0, "compressed"},
    {"short_mesh.serialized", 0, "too early"},
    {"huge_counts.serialized", 0, "4,294,967,295"},
    {"many_vertices.serialized", 0, "too short"},
    {"many_triangles.serialized", 0, "too short"},
    {"no_precision.serialized", 0, "precision"},
    {"tangents.serialized", 0, "tangents"},
    {"endless_name.serialized", 0, "name"},
    {"index_out_of_range.serialized", 0, "no vertex 3"},
    {"nan.serialized", 0, "vertex 1 is not finite"},
};

// Nothing is wrong with these but that they have nothing to show; the world leaves them out.
const char* const kEmptyFiles[] = {"empty.obj",          "no_faces.obj", "two_corners.obj",
                                   "all_degenerate.obj", "no_faces.ply", "degenerate.ply"};

std::string folder() { return std::string(LUMIRANK_TEST_DATA) + "/bad_meshes/"; }

std::string bytes_of_bad(const std::string& name) {
  std::ifstream in(folder() + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

MeshData parse_by_ending(const std::string& name, const std::string& bytes) {
  if (name.ends_with(".obj")) return parse_obj(bytes, name);
  if (name.ends_with(".ply")) return parse_ply(bytes, name);
  return parse_serialized(bytes, name, 0);
}

TEST(BadMeshes, AreRefusedWithFileLineAndReason) {
  for (const BadFile& bad : kBadMeshes) {
    ASSERT_TRUE(std::filesystem::exists(folder() + bad.name)) << bad.name;
    try {
      parse_by_ending(bad.name, bytes_of_bad(bad.name));
      ADD_FAILURE() << bad.name << " was accepted";
    } catch (const InputError& e) {
      EXPECT_EQ(e.where().file, bad.name);
      EXPECT_EQ(e.where().line, bad.line) << e.what();
      EXPECT_NE(std::string(e.what()).find(bad.phrase), std::string::npos) << e.what();
    }
  }
}

TEST(BadMeshes, AMeshWithoutATriangleIsReadAsOne) {
  for (const std::string name : kEmptyFiles) {
    const MeshData mesh = parse_by_ending(name, bytes_of_bad(name));
    EXPECT_EQ(mesh.triangle_count(), 0u) << name;
  }
  EXPECT_EQ(parse_by_ending("all_degenerate.obj", bytes_of_bad("all_degenerate.obj")).left_out.size(), 1u);
  EXPECT_EQ(parse_by_ending("two_corners.obj", bytes_of_bad("two_corners.obj")).left_out,
            std::vector<std::string>{"1 face with fewer than 3 corners"});
}

TEST(BadMeshes, TheCorpusHasNoFileThatIsNotTested) {
  std::set<std::string> listed(std::begin(kEmptyFiles), std::end(kEmptyFiles));
  for (const BadFile& bad : kBadMeshes) listed.insert(bad.name);
  for (const auto& entry : std::filesystem::directory_iterator(folder()))
    EXPECT_TRUE(listed.count(entry.path().filename().string())) << entry.path();
}

TEST(BadMeshes, AWrongShapeIndexIsToldHowManyThereAre) {
  const std::string bytes = serialized_file({SerializedMesh{}, SerializedMesh{}}, 4);
  for (const int index : {-1, 2, 1000}) {
    try {
      parse_serialized(bytes, "a.serialized", index);
      ADD_FAILURE() << index;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("holds 2 meshes"), std::string::npos) << e.what();
    }
  }
}

// What is cut off or changed anywhere is read or refused, and never worse. (Run under sanitizers, this is a
// small fuzzer; the real ones are in tests/fuzz.)
TEST(BadMeshes, AnyCutAndAnyChangedByteIsReadOrRefused) {
  SerializedMesh mesh;
  mesh.uvs = {0, 0, 1, 0, 0, 1};
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const float v : {0, 0, 0, 1, 0, 0, 0, 1, 0}) put(ply, v);
  put<std::uint8_t>(ply, 3);
  for (const int i : {0, 1, 2}) put<std::int32_t>(ply, i);
  const std::pair<std::string, std::string> good[] = {
      {"a.obj", "v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 0 1 0 1 0 1\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 -1/-1/-1\n"},
      {"a.ply", ply},
      {"a.serialized", serialized_file({mesh, mesh}, 4)},
      {"b.serialized", serialized_file({mesh}, 3)}};
  for (const auto& [name, bytes] : good) {
    ASSERT_EQ(parse_by_ending(name, bytes).triangle_count(), 1u) << name;
    auto attempt = [&, name = name](const std::string& changed) {
      try {
        const MeshData m = parse_by_ending(name, changed);
        for (const std::uint32_t i : m.indices) ASSERT_LT(i, m.positions.size());
      } catch (const InputError& e) {
        EXPECT_EQ(e.where().file, name);
      }
    };
    for (std::size_t n = 0; n < bytes.size(); ++n) attempt(bytes.substr(0, n));
    Rng rng(21, Stage::test);
    for (int k = 0; k < 2000; ++k) {
      std::string changed = bytes;
      for (std::uint64_t n = rng.next_below(3) + 1; n > 0; --n)
        changed[rng.next_below(changed.size())] = static_cast<char>(rng.next_below(256));
      attempt(changed);
    }
  }
}

}  // namespace
}  // namespace lumirank::scenedesc
