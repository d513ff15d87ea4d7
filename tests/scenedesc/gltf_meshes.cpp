// glTF geometry: containers, accessors of every kind, primitives, nodes, skins.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "gltf_maker.h"

namespace lumirank::scenedesc {
namespace {

using json = nlohmann::json;

std::vector<Vec3f> corner_positions(const MeshData& mesh) {
  std::vector<Vec3f> out;
  for (const std::uint32_t k : mesh.indices) out.push_back(mesh.positions[k]);
  return out;
}

Vec3f face_normal(const MeshData& mesh, std::size_t triangle) {
  const std::uint32_t* c = &mesh.indices[3 * triangle];
  return normalize(
      cross(mesh.positions[c[1]] - mesh.positions[c[0]], mesh.positions[c[2]] - mesh.positions[c[0]]));
}

TEST(GltfMesh, TextAndBinaryContainersAgree) {
  const GltfMaker m = square();
  const SceneDesc text = parse(m), binary = parse_gltf(m.glb(), "made.glb");
  EXPECT_EQ(text.format, "glTF 2.0");
  ASSERT_EQ(text.shapes.size(), 1u);
  EXPECT_EQ(corner_positions(mesh_of(text)), corner_positions(mesh_of(binary)));
  EXPECT_EQ(mesh_of(text).indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(mesh_of(text).normals.empty()) << "flat shading without normals";
}

TEST(GltfMesh, IndicesOfAllTypesAndNone) {
  GltfMaker m;
  const int positions = m.accessor("VEC3", kSquare);
  const int loose =
      m.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0});
  const int narrow = m.accessor("SCALAR", std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3});
  const int middle = m.accessor("SCALAR", std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3});
  const int wide = m.accessor("SCALAR", std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
  json primitives = json::array();
  for (const int indices : {narrow, middle, wide})
    primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  primitives.push_back({{"attributes", {{"POSITION", loose}}}});
  m.root["meshes"] = {{{"primitives", primitives}}};
  const SceneDesc scene = parse(m);
  ASSERT_EQ(scene.shapes.size(), 4u);
  for (std::size_t k = 1; k < 4; ++k)
    EXPECT_EQ(corner_positions(mesh_of(scene, k)), corner_positions(mesh_of(scene, 0))) << k;
}

// Five points of a zigzag, or of a fan around the first: three triangles that all face +z.
TEST(GltfMesh, StripsAndFansFaceOneWay) {
  for (const int mode : {5, 6}) {
    GltfMaker m;
    const std::vector<float> zigzag = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    const std::vector<float> fan = {0, 0, 0, 2, 0, 0, 2, 1, 0, 1, 2, 0, 0, 2, 0};
    const int positions = m.accessor("VEC3", mode == 5 ? zigzag : fan);
    m.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"mode", mode}}}}}};
    const SceneDesc scene = parse(m);
    const MeshData& mesh = mesh_of(scene);
    ASSERT_EQ(mesh.triangle_count(), 3u);
    for (std::size_t t = 0; t < 3; ++t) EXPECT_EQ(face_normal(mesh, t), (Vec3f{0, 0, 1})) << mode << ' ' << t;
  }
}

TEST(GltfMesh, PointsAndLinesAreLeftOutWithAWarning) {
  for (const int mode : {0, 1, 2, 3}) {
    GltfMaker m = square();
    json line = m.root["meshes"][0]["primitives"][0];
    line["mode"] = mode;
    m.root["meshes"][0]["primitives"].push_back(line);
    const SceneDesc scene = parse(m);
    EXPECT_EQ(scene.shapes.size(), 1u);
    EXPECT_NE(warning_about(scene, "meshes[0].primitives[1]"), nullptr) << describe(scene);
    EXPECT_NE(failure(m.gltf(), {{}, true}), "");
  }
}

TEST(GltfMesh, NormalizedAndPlainIntegers) {
  GltfMaker m = square();
  auto& attributes = m.root["meshes"][0]["primitives"][0]["attributes"];
  // KHR_mesh_quantization: positions as plain shorts, normals as signed bytes, uv as unsigned shorts.
  attributes["POSITION"] =
      m.accessor("VEC3", std::vector<std::int16_t>{0, 0, 0, 300, 0, 0, 300, -7, 0, 0, 1, 0});
  attributes["NORMAL"] =
      m.accessor("VEC3", std::vector<std::int8_t>{0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, -128}, true);
  attributes["TEXCOORD_0"] =
      m.accessor("VEC2", std::vector<std::uint16_t>{0, 65535, 13107, 0, 0, 0, 0, 0}, true);
  attributes["COLOR_0"] = m.accessor(
      "VEC4", std::vector<std::uint8_t>{255, 51, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255}, true);
  const SceneDesc scene = parse(m);
  const MeshData& mesh = mesh_of(scene);
  EXPECT_EQ(mesh.positions[2], (Vec3f{300, -7, 0}));
  EXPECT_EQ(mesh.normals[0], (Vec3f{0, 0, 1}));
  EXPECT_EQ(mesh.normals[3], (Vec3f{0, 0, -1}));
  EXPECT_EQ(mesh.uvs[0].y, 1);
  EXPECT_NEAR(mesh.uvs[1].x, 0.2f, 1e-7f);
  EXPECT_NEAR(mesh.colors[0].g, 0.2f, 1e-7f);
}

TEST(GltfMesh, StridedViewsAndOffsets) {
  GltfMaker m = square();
  // Position and uv of each vertex side by side: 20 bytes.
  std::vector<float> both;
  for (std::size_t k = 0; k < 4; ++k) {
    both.insert(both.end(), {kSquare[3 * k], kSquare[3 * k + 1], kSquare[3 * k + 2]});
    both.insert(both.end(), {static_cast<float>(k), 0.5f});
  }
  const int view = m.view(both, 20);
  auto& attributes = m.root["meshes"][0]["primitives"][0]["attributes"];
  const json accessor = {{"bufferView", view}, {"componentType", 5126}, {"count", 4}};
  m.root["accessors"].push_back(accessor);
  m.root["accessors"].back()["type"] = "VEC3";
  m.root["accessors"].push_back(accessor);
  m.root["accessors"].back()["type"] = "VEC2";
  m.root["accessors"].back()["byteOffset"] = 12;
  attributes["POSITION"] = m.root["accessors"].size() - 2;
  attributes["TEXCOORD_0"] = m.root["accessors"].size() - 1;
  const SceneDesc scene = parse(m);
  EXPECT_EQ(mesh_of(scene).positions[2], (Vec3f{1, 1, 0}));
  EXPECT_EQ(mesh_of(scene).uvs[3].x, 3);
}

TEST(GltfMesh, SparseAccessorsWithAndWithoutABase) {
  GltfMaker m = square();
  const int indices = m.view(std::vector<std::uint16_t>{1, 2});
  const int values = m.view(std::vector<float>{5, 0, 0, 6, 7, 0});
  const json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                       {"values", {{"bufferView", values}}}};
  m.root["accessors"][0]["sparse"] = sparse;
  SceneDesc scene = parse(m);
  EXPECT_EQ(mesh_of(scene).positions, (std::vector<Vec3f>{{0, 0, 0}, {5, 0, 0}, {6, 7, 0}, {0, 1, 0}}));
  m.root["accessors"][0].erase("bufferView");  // zeros
  m.root["meshes"][0]["primitives"][0].erase("indices");
  m.root["accessors"][0]["count"] = 3;
  scene = parse(m);
  EXPECT_EQ(mesh_of(scene).positions, (std::vector<Vec3f>{{0, 0, 0}, {5, 0, 0}, {6, 7, 0}}));
}

TEST(GltfNodes, TransformsChainFromTheTop) {
  GltfMaker m = square();
  const double s = std::sqrt(0.5);
  // A quarter turn about z, then doubled, then moved; the child's matrix moves by (1, 0, 0) first.
  m.root["nodes"] = {
      {{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, s, s}}, {"scale", {2, 2, 2}}},
      {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}}}};
  const SceneDesc scene = parse(m);
  ASSERT_EQ(scene.shapes.size(), 1u);
  const Vec3f p =
      scene.shapes[0].to_world.point({1, 0, 0});  // (2, 0, 0) → (4, 0, 0) → (0, 4, 0) → (10, 4, 0)
  EXPECT_NEAR(p.x, 10, 1e-6f);
  EXPECT_NEAR(p.y, 4, 1e-6f);
}

TEST(GltfNodes, MeshesUsedTwiceAreSharedAndOtherScenesLeftOut) {
  GltfMaker m = square();
  m.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {0, 0, 1}}}, {{"mesh", 0}}};
  m.root["scenes"] = {{{"nodes", {2}}}, {{"nodes", {0, 1}}}};
  m.root["scene"] = 1;
  const SceneDesc scene = parse(m);
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(std::get<InlineMeshDesc>(scene.shapes[0].kind).mesh,
            std::get<InlineMeshDesc>(scene.shapes[1].kind).mesh);
  EXPECT_EQ(scene.shapes[1].to_world.m[11], 1);
}

TEST(GltfNodes, GpuInstancing) {
  GltfMaker m = square();
  const int moves = m.accessor("VEC3", std::vector<float>{1, 0, 0, 2, 0, 0});
  const int scales = m.accessor("VEC3", std::vector<float>{1, 1, 1, 3, 3, 3});
  m.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", moves},
                                                                               {"SCALE", scales}};
  const SceneDesc scene = parse(m);
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[1].to_world.point({1, 0, 0}), (Vec3f{5, 0, 0}));
}

TEST(GltfPoses, MorphTargetsByTheirWeights) {
  GltfMaker m = square();
  const int up = m.accessor("VEC3", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int right = m.accessor("VEC3", std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0});
  m.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}, {{"POSITION", right}}};
  m.root["meshes"][0]["weights"] = {0.5, 0};
  EXPECT_EQ(mesh_of(parse(m)).positions[0], (Vec3f{0, 0, 0.5f}));
  m.root["nodes"][0]["weights"] = {0, 2};  // wins
  EXPECT_EQ(mesh_of(parse(m)).positions[0], (Vec3f{2, 0, 0}));
}

TEST(GltfPoses, SkinsInThePoseOfTheirNodes) {
  GltfMaker m = square();
  // Two joints: one at rest, one moved by (0, 0, 4) from where it was bound at (0, 0, 1). Vertices 0 and 1
  // follow the first, 2 the second, 3 both alike. The skinned node's own transform means nothing.
  auto& attributes = m.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] =
      m.accessor("VEC4", std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
  attributes["WEIGHTS_0"] =
      m.accessor("VEC4", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0});
  std::vector<float> inverse(32, 0.0f);
  for (const std::size_t k : {0u, 5u, 10u, 15u, 16u, 21u, 26u, 31u}) inverse[k] = 1;
  inverse[16 + 14] = -1;
  const int bind = m.accessor("MAT4", inverse);
  m.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", bind}}};
  m.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {9, 9, 9}}},
                     {{"name", "rest"}},
                     {{"translation", {0, 0, 5}}}};
  m.root["scenes"][0]["nodes"] = {0, 1, 2};
  const SceneDesc scene = parse(m);
  EXPECT_TRUE(scene.shapes[0].to_world.is_identity());
  EXPECT_EQ(mesh_of(scene).positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 4}, {0, 1, 2}}));
}

}  // namespace
}  // namespace lumirank::scenedesc
