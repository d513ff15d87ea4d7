// Good mesh files in every form that the readers know, written here.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "mesh_builders.h"
#include "scenedesc/readers.h"

namespace lumirank::scenedesc {
namespace {

using Indices = std::vector<std::uint32_t>;

// ----------------------------------------------------------------------------------------------------------
// OBJ

TEST(ObjReader, ReadsEveryFormOfFaceIndex) {
  const std::string vertices =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 2\nvn 0 0 1\nvn 0 0 1\n";
  for (const std::string face :
       {"f 1 2 3", "f -3 -2 -1", "f 1/1 2/2 3/3", "f 1//1 2//2 3//3", "f 1/1/1 2/2/2 3/3/3",
        "f -3/-3/-3 -2/-2/-2 -1/-1/-1", "  f\t1/1/1  2/2/2 3/3/3 # end\r", "f 1/ 2/ 3/", "f 1 2 \\\n 3",
        "fo 1 2 3"}) {
    const MeshData mesh = parse_obj(vertices + face + "\n", "a.obj");
    EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << face;
    EXPECT_EQ(mesh.indices, (Indices{0, 1, 2})) << face;
    const bool uv = face.find("1/1") != std::string::npos || face.find("-3/-3") != std::string::npos;
    const bool normal = face.find("//1") != std::string::npos || face.find("/1/1") != std::string::npos ||
                        face.find("-3/-3/-3") != std::string::npos;
    if (uv)
      EXPECT_EQ(mesh.uvs, (std::vector<Vec2f>{{0, 0}, {1, 0}, {0, 1}})) << face;
    else
      EXPECT_TRUE(mesh.uvs.empty()) << face;
    if (normal)
      EXPECT_EQ(mesh.normals, std::vector<Vec3f>(3, Vec3f{0, 0, 1})) << face;  // made unit length
    else
      EXPECT_TRUE(mesh.normals.empty()) << face;
    EXPECT_TRUE(mesh.left_out.empty() && mesh.mended.empty()) << face;
  }
}

TEST(ObjReader, SharesVerticesThatAreTheSameInAllParts) {
  // Two triangles of a quad share an edge; one corner of the edge has another uv in the second triangle.
  const MeshData mesh = parse_obj(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvt 0.5 0.5\n"
      "f 1/1 2/1 3/2\nf 1/1 3/3 4/1",
      "a.obj");
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 0, 3, 4}));
  EXPECT_EQ(mesh.positions[3], mesh.positions[2]);
  EXPECT_EQ(mesh.uvs[3], (Vec2f{0.5f, 0.5f}));
}

TEST(ObjReader, CutsPolygonsIntoFans) {
  const MeshData quad = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", "a.obj");
  EXPECT_EQ(quad.indices, (Indices{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(quad.left_out.empty() && quad.mended.empty());
  const MeshData pentagon = parse_obj("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv -1 1 0\nf 1 2 3 4 5\n", "a.obj");
  EXPECT_EQ(pentagon.indices, (Indices{0, 1, 2, 0, 2, 3, 0, 3, 4}));
  EXPECT_EQ(pentagon.mended.size(), 1u);
}

TEST(ObjReader, ReadsColorsAndPassesOverTheRest) {
  const MeshData mesh = parse_obj(
      "\xef\xbb\xbf# comment\nmtllib a.mtl\no thing\ng group\ns off\nusemtl red\n"
      "v 0 0 0 1 0 0.5\nv +1 0 0 0 1 0\nv 0 1e0 0.0E+00 0.25 0.5 1\nl 1 2\np 1\nf 1 2 3",
      "a.obj");
  EXPECT_EQ(mesh.colors, (std::vector<Rgb>{{1, 0, 0.5f}, {0, 1, 0}, {0.25f, 0.5f, 1}}));
  EXPECT_EQ(mesh.positions[1].x, 1);
}

TEST(ObjReader, MendsWhatCanBeMended) {
  const MeshData mesh = parse_obj(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nvn 0 0 0\nvn 0 1 0\nvn nan 0 0\n"
      "f 1//1 2//2 3//3\nf 1//1 2//2 4//2\nf 1//1 1//1 2//2\n",
      "a.obj");
  EXPECT_EQ(mesh.triangle_count(), 1u);  // the second is a line, the third repeats a corner
  EXPECT_EQ(mesh.normals[0], (Vec3f{0, 0, 1}));
  EXPECT_EQ(mesh.normals[1], (Vec3f{0, 1, 0}));
  EXPECT_EQ(mesh.normals[2], (Vec3f{0, 0, 1}));
  EXPECT_EQ(mesh.left_out, std::vector<std::string>{"2 degenerate triangles"});
  EXPECT_EQ(mesh.mended,
            (std::vector<MeshData::Mended>{{"2 missing normals", "the direction of the faces around"}}));
  // Numbers beyond a float's range: too small is 0.
  EXPECT_EQ(parse_obj("v 1e-60 0.0000 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", "a.obj").positions[0].x, 0);
}

TEST(ObjReader, SaysNothingAboutVerticesThatNoTriangleUses) {
  // The normal and the texture coordinate that are not numbers belong to the degenerate triangle alone.
  const MeshData mesh = parse_obj(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nvt 0 0\nvt nan 0\nvn 0 0 1\nvn nan 0 0\n"
      "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 2/1/1 4/2/2\n",
      "a.obj");
  EXPECT_EQ(mesh.left_out, std::vector<std::string>{"1 degenerate triangle"});
  EXPECT_TRUE(mesh.mended.empty());
  const MeshData used = parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt nan 0\nf 1/1 2/1 3/2\n", "a.obj");
  EXPECT_EQ(used.mended, (std::vector<MeshData::Mended>{{"1 texture coordinate that is not finite", "0"}}));
}

// ----------------------------------------------------------------------------------------------------------
// PLY

// The same quad and triangle, with every property, in the three formats.
std::string ply_file(const std::string& format) {
  std::string out =
      "ply\r\nformat " + format +
      " 1.0\r\ncomment made by a test\r\nobj_info nothing\r\n"
      "element junk 2\r\nproperty list ushort short things\r\nproperty double d\r\n"
      "element vertex 5\r\nproperty uchar red\r\nproperty double x\r\nproperty uchar green\r\n"
      "property float y\r\nproperty short z\r\nproperty uchar blue\r\nproperty float quality\r\n"
      "property float nx\r\nproperty float ny\r\nproperty float nz\r\n"
      "property float s\r\nproperty float t\r\nproperty list uchar int ring\r\n"
      "element face 3\r\nproperty int flags\r\nproperty list uint8 uint vertex_index\r\n"
      "element edge 1\r\nproperty int a\r\nend_header\r\n";
  if (format == "ascii") {
    return out +
           "3 7 -8 9 1.5\r\n0 -2\r\n"
           "255 0 0 0 0 51 9 0 0 2 0 0 0\r\n0 1 255 0 0 0 9 0 0 1 1 0 1 4\n0 1 0 1 0 0 9 0 0 1 1 1 2 4 5\n"
           "0 0 0 1 0 0 9 0 0 1 0 1 0\n0 0 0 2.5 -3 0 9 0 0 1 0.5 2 0\n"
           "7 4 0 1 2 3\n8 3 3 2 4\n9 2 0 1\n"
           "42";
  }
  const bool big = format == "binary_big_endian";
  put<std::uint16_t>(out, 3, big);
  for (const int v : {7, -8, 9}) put<std::int16_t>(out, static_cast<std::int16_t>(v), big);
  put(out, 1.5, big);
  put<std::uint16_t>(out, 0, big);
  put(out, -2.0, big);
  const double vertices[5][12] = {{255, 0, 0, 0, 0, 51, 9, 0, 0, 2, 0, 0},
                                  {0, 1, 255, 0, 0, 0, 9, 0, 0, 1, 1, 0},
                                  {0, 1, 0, 1, 0, 0, 9, 0, 0, 1, 1, 1},
                                  {0, 0, 0, 1, 0, 0, 9, 0, 0, 1, 0, 1},
                                  {0, 0, 0, 2.5, -3, 0, 9, 0, 0, 1, 0.5, 2}};
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 12; ++j) {
      const double v = vertices[k][j];
      if (j == 0 || j == 2 || j == 5)
        put(out, static_cast<std::uint8_t>(v), big);
      else if (j == 1)
        put(out, v, big);
      else if (j == 4)
        put(out, static_cast<std::int16_t>(v), big);
      else
        put(out, static_cast<float>(v), big);
    }
    put<std::uint8_t>(out, static_cast<std::uint8_t>(k % 3));
    for (int j = 0; j < k % 3; ++j) put<std::int32_t>(out, 4 + j, big);
  }
  const Indices faces[3] = {{0, 1, 2, 3}, {3, 2, 4}, {0, 1}};
  for (const Indices& f : faces) {
    put<std::int32_t>(out, 7, big);
    put(out, static_cast<std::uint8_t>(f.size()));
    for (const std::uint32_t i : f) put(out, i, big);
  }
  put<std::int32_t>(out, 42, big);
  return out;
}

TEST(PlyReader, ReadsTheSameFromAllFormats) {
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const MeshData mesh = parse_ply(ply_file(format), "a.ply");
    EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 2.5f, -3}}))
        << format;
    EXPECT_EQ(mesh.normals, std::vector<Vec3f>(5, Vec3f{0, 0, 1})) << format;
    EXPECT_EQ(mesh.uvs, (std::vector<Vec2f>{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5f, 2}})) << format;
    ASSERT_EQ(mesh.colors.size(), 5u);
    EXPECT_FLOAT_EQ(mesh.colors[0].r, 1);
    EXPECT_FLOAT_EQ(mesh.colors[0].b, 0.2f);
    EXPECT_FLOAT_EQ(mesh.colors[1].g, 1);
    EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 0, 2, 3, 3, 2, 4})) << format;
    EXPECT_EQ(mesh.left_out, std::vector<std::string>{"1 face with fewer than 3 corners"});
    EXPECT_TRUE(mesh.mended.empty());
  }
}

TEST(PlyReader, KnowsTheOtherNamesOfProperties) {
  for (const std::string uv : {"u v", "s t", "texture_u texture_v", "texture_s texture_t"}) {
    const std::string u = uv.substr(0, uv.find(' ')), v = uv.substr(uv.find(' ') + 1);
    const MeshData mesh = parse_ply(
        "ply\nformat ascii 1.0\nelement face 1\nproperty list char int vertex_indices\n"
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float " +
            v + "\nproperty float " + u +
            "\nproperty float r\nproperty float g\nproperty float b\nend_header\n"
            "3 0 1 2\n0 0 0 0.25 0.5 2 3 4\n1 0 0 0 0 0 0 0\n0 1 0 0 0 0 0 0\n",
        "a.ply");  // the faces come first
    EXPECT_EQ(mesh.uvs[0], (Vec2f{0.5f, 0.25f}));
    EXPECT_EQ(mesh.colors[0], Rgb(2, 3, 4));
    EXPECT_TRUE(mesh.normals.empty());
  }
}

// ---------------------------------------------------------------------------------------------------
// serialized

TEST(SerializedReader, ReadsBothVersionsAndPrecisions) {
  for (const int version : {3, 4}) {
    for (const std::uint32_t precision : {0x1000u, 0x2000u}) {
      SerializedMesh first, second;
      first.flags = second.flags = precision;
      second.name = "";
      second.positions = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0};
      second.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 3, 0};
      second.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
      second.colors = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0.25, 0.125};
      second.indices = {0, 1, 2, 0, 2, 3};
      const std::string bytes = serialized_file({first, second}, version);
      const MeshData a = parse_serialized(bytes, "a.serialized", 0);
      EXPECT_EQ(a.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
      EXPECT_TRUE(a.normals.empty() && a.uvs.empty() && a.colors.empty());
      const MeshData b = parse_serialized(bytes, "a.serialized", 1);
      EXPECT_EQ(b.positions, (std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}));
      EXPECT_EQ(b.normals[3], (Vec3f{0, 1, 0}));
      EXPECT_EQ(b.uvs[2], (Vec2f{1, 1}));
      EXPECT_EQ(b.colors[3], Rgb(0.5f, 0.25f, 0.125f));
      EXPECT_EQ(b.indices, (Indices{0, 1, 2, 0, 2, 3}));
    }
  }
}

// ----------------------------------------------------------------------------------------------------
// read_mesh

struct TemporaryFile {
  std::string name;
  TemporaryFile(const std::string& bytes, const std::string& extension)
      : name((std::filesystem::temp_directory_path() /
              ("lumirank_mesh_" + std::to_string(::getpid()) + extension))
                 .string()) {
    std::ofstream(name, std::ios::binary) << bytes;
  }
  ~TemporaryFile() { std::filesystem::remove(name); }
};

// A roof: two squares that meet at x = 0 with an angle of 90° between their normals (-1, 0, 1)/√2 and (1, 0,
// 1)/√2.
const std::string kRoof =
    "v -1 0 -1\nv 0 0 0\nv 0 1 0\nv -1 1 -1\nv 1 0 -1\nv 1 1 -1\nvt 0.25 0.125\n"
    "f 1/1 2/1 3/1 4/1\nf 2/1 5/1 6/1 3/1\n";

TEST(ReadMesh, MakesNormalsAsTheSceneAsks) {
  const TemporaryFile file(kRoof, ".obj");
  MeshFileDesc desc;
  desc.filename = file.name;
  const float h = std::sqrt(0.5f);
  auto expect_normal = [](Vec3f n, Vec3f expected) { EXPECT_LT(length(n - expected), 1e-6f); };

  // None in the file: smooth, as in Mitsuba. Both ridge vertices see an angle of 90° of each side.
  MeshData mesh = read_mesh(desc);
  ASSERT_EQ(mesh.positions.size(), 6u);
  expect_normal(mesh.normals[0], {-h, 0, h});
  expect_normal(mesh.normals[1], {0, 0, 1});
  expect_normal(mesh.normals[2], {0, 0, 1});
  expect_normal(mesh.normals[4], {h, 0, h});

  desc.face_normals = true;
  EXPECT_TRUE(read_mesh(desc).normals.empty());
  desc.face_normals = false;

  desc.max_smooth_angle = 91;
  mesh = read_mesh(desc);
  EXPECT_EQ(mesh.positions.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k)
    expect_normal(mesh.normals[k], {h * mesh.positions[k].x, 0, mesh.positions[k].x == 0 ? 1 : h});

  desc.max_smooth_angle = 89;
  desc.flip_tex_coords = true;
  mesh = read_mesh(desc);
  ASSERT_EQ(mesh.positions.size(), 8u);  // the ridge is split
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (int c = 0; c < 3; ++c) expect_normal(mesh.normals[mesh.indices[3 * t + c]], {t < 2 ? -h : h, 0, h});
  for (const Vec2f& uv : mesh.uvs) EXPECT_EQ(uv, (Vec2f{0.25f, 0.875f}));

  desc.max_smooth_angle = -1;
  EXPECT_THROW(read_mesh(desc), InputError);
}

TEST(ReadMesh, ObeysTheFaceNormalsOfASerializedFile) {
  SerializedMesh plain, flat;
  flat.flags |= 0x10;
  flat.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1};
  const TemporaryFile file(serialized_file({plain, flat}, 4), ".serialized");
  MeshFileDesc desc;
  desc.format = MeshFormat::serialized;
  desc.filename = file.name;
  EXPECT_EQ(read_mesh(desc).normals, std::vector<Vec3f>(3, Vec3f{0, 0, 1}));
  desc.shape_index = 1;
  EXPECT_TRUE(read_mesh(desc).normals.empty());
}

TEST(ReadMesh, NamesAFileThatIsMissing) {
  MeshFileDesc desc;
  desc.filename = "/nonexistent/mesh.ply";
  desc.format = MeshFormat::ply;
  try {
    read_mesh(desc);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.where().file, desc.filename);
  }
  desc.filename = std::filesystem::temp_directory_path().string();
  EXPECT_THROW(read_mesh(desc), InputError);
}

}  // namespace
}  // namespace lumirank::scenedesc
