// Scenes that are not whole, through reading and building: a mesh without a triangle never ends a load,
// broken files are refused with the scene's line and the shape, missing files get a stand-in where that is
// allowed, and nothing that doubles itself is followed.
#include "world/loading_corpus.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "base/error.h"
#include "scenedesc/mesh_builders.h"
#include "scenedesc/readers.h"
#include "world/world.h"

namespace lumirank::test {

void write_corpus_files(const std::string& folder) {
  std::filesystem::create_directories(folder + "/folder.obj");
  std::filesystem::create_directories(folder + "/folder.png");
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(folder + "/" + name, std::ios::binary) << bytes;
  };
  write("empty.obj", "");
  write("cut.binary", "MERL");
  write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  write("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  write("two_corners.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n");
  write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n");
  write("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("some_flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\nf 2 3\n");
  write("far_index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  write("zero_index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n");
  write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
  write("word.obj", "v 0 0 0\nv 1 o 0\nv 0 1 0\nf 1 2 3\n");
  const std::string head = "ply\nformat ascii 1.0\n",
                    xyz = "property float x\nproperty float y\nproperty float z\n",
                    list = "property list uchar int vertex_indices\nend_header\n";
  const std::string three =
      head + "element vertex 3\n" + xyz + "element face 1\n" + list + "0 0 0\n1 0 0\n0 1 0\n";
  write("good.ply", three + "3 0 1 2\n");
  write("points.ply", head + "element vertex 1\n" + xyz + "end_header\n0 0 0\n");
  write("nothing.ply", head + "element vertex 0\n" + xyz + "element face 0\n" + list);
  write("no_face.ply",
        head + "element vertex 3\n" + xyz + "element face 0\n" + list + "0 0 0\n1 0 0\n0 1 0\n");
  write("flat.ply", three + "3 0 1 1\n");
  write("two_corners.ply", three + "2 0 1\n");
  write("far_index.ply", three + "3 0 1 7\n");
  write("cut.ply", head + "element vertex 3\n" + xyz + "element face 1\n" + list + "0 0 0\n1 0");
  write("text.ply", "solid cup\n");
  write("empty.ply", "");
  scenedesc::SerializedMesh mesh;
  write("good.serialized", scenedesc::serialized_file({mesh}, 4));
  mesh.indices = {0, 0, 1};
  write("flat.serialized", scenedesc::serialized_file({mesh}, 4));
  mesh.indices = {};
  write("no_face.serialized", scenedesc::serialized_file({mesh}, 4));
  mesh.indices = {0, 1, 5};
  write("far_index.serialized", scenedesc::serialized_file({mesh}, 4));
  write("cut.serialized", scenedesc::serialized_file({mesh}, 4).substr(0, 20));
  write("empty.serialized", "");
  write("empty.curves", "");
  write("blank.curves", "\n \n");
  write("short.curves", "0 0 0 1\n1 0 0 1\n");
  write("good.curves", "0 0 0 .1\n1 0 0 .1\n1 1 0 .1\n2 2 0 .1\n");
  write("empty.png", "");
  write("text.png", "not a picture\n");
  write("cut.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0", 18));
  write("empty.exr", "");
  write("cut.exr", std::string("\x76\x2f\x31\x01\x02\0\0\0", 8));
  write("cut.pfm", "PF\n4 4\n-1.0\nabc");
  write("good.pfm", std::string("PF\n1 1\n-1.0\n") + std::string("\0\0\0?\0\0\0?\0\0\0?", 12));
  write("nan.pfm", std::string("PF\n1 1\n-1.0\n") + std::string("\0\0\xc0\x7f\0\0\0?\0\0\0?", 12));
  write("cut.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 100");
  write("empty.ies", "");
}

namespace {

const std::string& corpus_folder() {
  static const std::string folder = [] {
    std::string made = testing::TempDir() + "lumirank_loading_corpus";
    write_corpus_files(made);
    return made;
  }();
  return folder;
}

void check(const LoadingCase& c) {
  SCOPED_TRACE(c.name);
  namespace sd = scenedesc;
  using Format = LoadingCase::Format;
  using Outcome = LoadingCase::Outcome;
  const std::string extension =
      c.format == Format::xml ? ".xml" : (c.format == Format::pbrt ? ".pbrt" : ".gltf");
  const std::string file = corpus_folder() + "/" + c.name + extension;
  sd::ReadOptions options;
  options.allow_missing = c.allow_missing, options.strict = c.strict;
  try {
    sd::SceneDesc desc = c.format == Format::xml    ? sd::parse_mitsuba(c.text, file, options)
                         : c.format == Format::pbrt ? sd::parse_pbrt(c.text, file, options)
                                                    : sd::parse_gltf(c.text, file, options);
    if (c.format == Format::gltf) sd::light_if_dark(desc);
    std::vector<sd::Warning> warnings = desc.warnings;
    const world::World world = world::World::build(desc, {c.strict}, warnings);
    EXPECT_NE(c.outcome, Outcome::refused) << "it loads";
    EXPECT_EQ(world.info().meshes_left_out, c.left_out);
    EXPECT_FALSE(sd::describe(desc).empty());
    std::string all;
    bool found = c.says.empty();
    std::size_t counted = 0;
    for (const sd::Warning& w : warnings) {
      if (w.harmless || w.what == "the scene has no light") continue;
      ++counted;
      all += to_string(w.where) + ": " + w.what + " | " + w.used_instead + "\n";
      found = found || ((w.what + " | " + w.used_instead).find(c.says) != std::string::npos &&
                        (c.line == 0 || (w.where.line == c.line && w.where.file == file)));
    }
    EXPECT_TRUE(found) << "warned of:\n" << all;
    EXPECT_EQ(counted == 0, c.outcome == Outcome::loads) << "warned of:\n" << all;
  } catch (const InputError& e) {
    const std::string what = e.what();
    EXPECT_EQ(c.outcome, Outcome::refused) << what;
    EXPECT_NE(what.find(c.says), std::string::npos) << what;
    EXPECT_NE(what.find(file), std::string::npos) << what;
    if (c.line > 0) {
      EXPECT_EQ(what.find(file + ":" + std::to_string(c.line) + ": "), 0u) << what;
    }
  }
}

void check_all(const std::vector<LoadingCase>& cases, std::size_t min_cases) {
  std::set<std::string> names;
  for (const LoadingCase& c : cases) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name << " is there twice";
    check(c);
  }
  EXPECT_GE(cases.size(), min_cases);
}

TEST(LoadingCorpus, MeshesWithoutATriangleAreLeftOut) { check_all(meshes_without_triangles(), 35); }
TEST(LoadingCorpus, BrokenFilesNameTheirShape) { check_all(broken_files(), 35); }
TEST(LoadingCorpus, MissingFiles) { check_all(missing_files(), 35); }
TEST(LoadingCorpus, WhatDoublesItselfIsNotFollowed) { check_all(nested_without_end(), 20); }
TEST(LoadingCorpus, OddScenes) { check_all(odd_scenes(), 20); }

}  // namespace
}  // namespace lumirank::test
