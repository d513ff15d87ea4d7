// Compressed glTF meshes: packed here by the libraries' encoders, and back.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>

#include "gltf_maker.h"

namespace lumirank::scenedesc {
namespace {

using Corner = std::array<float, 5>;  // position and uv
using Triangle = std::array<Corner, 3>;

// Triangles as a sorted list, each from its smallest corner on: encoders may turn and reorder them.
std::vector<Triangle> sorted(const MeshData& mesh) {
  std::vector<Triangle> out;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    Triangle made;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t k = mesh.indices[3 * t + c];
      const Vec3f p = mesh.positions[k];
      const Vec2f uv = mesh.uvs.empty() ? Vec2f{} : mesh.uvs[k];
      made[c] = {p.x, p.y, p.z, uv.x, uv.y};
    }
    std::rotate(made.begin(), std::min_element(made.begin(), made.end()), made.end());
    out.push_back(made);
  }
  std::sort(out.begin(), out.end());
  return out;
}

TEST(GltfCompressed, Meshopt) {
  const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 2, 3};
  std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(4, 12));
  vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), kSquare.data(), 4, 12));
  std::vector<unsigned char> triangles(meshopt_encodeIndexBufferBound(6, 4));
  triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), 6));
  std::vector<unsigned char> sequence(meshopt_encodeIndexSequenceBound(6, 4));
  sequence.resize(meshopt_encodeIndexSequence(sequence.data(), sequence.size(), indices.data(), 6));
  // Unit normals along +z, -x, +y, +z, as signed bytes by the octahedral filter.
  const float normals[] = {0, 0, 1, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  std::vector<signed char> octahedral(16);
  meshopt_encodeFilterOct(octahedral.data(), 4, 4, 8, normals);
  std::vector<unsigned char> directions(meshopt_encodeVertexBufferBound(4, 4));
  directions.resize(
      meshopt_encodeVertexBuffer(directions.data(), directions.size(), octahedral.data(), 4, 4));

  for (const bool as_triangles : {true, false}) {
    GltfMaker m;
    const auto packed = [&](const std::vector<unsigned char>& bytes, int stride, int count, const char* mode,
                            const char* filter) {
      const int view = m.view(bytes);
      auto& made = m.root["bufferViews"][static_cast<std::size_t>(view)];
      made["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                       {"byteOffset", made["byteOffset"]},
                                                       {"byteLength", bytes.size()},
                                                       {"byteStride", stride},
                                                       {"count", count},
                                                       {"mode", mode},
                                                       {"filter", filter}};
      made["buffer"] = 1;  // the fallback, which is never read
      made["byteOffset"] = 0;
      made["byteLength"] = stride * count;
      return view;
    };
    m.root["accessors"] = {{{"bufferView", packed(vertices, 12, 4, "ATTRIBUTES", "NONE")},
                            {"componentType", 5126},
                            {"count", 4},
                            {"type", "VEC3"}},
                           {{"bufferView", as_triangles ? packed(triangles, 4, 6, "TRIANGLES", "NONE")
                                                        : packed(sequence, 4, 6, "INDICES", "NONE")},
                            {"componentType", 5125},
                            {"count", 6},
                            {"type", "SCALAR"}}};
    const int view = packed(directions, 4, 4, "ATTRIBUTES", "OCTAHEDRAL");
    m.root["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 4;
    m.root["accessors"].push_back({{"bufferView", view},
                                   {"componentType", 5120},
                                   {"normalized", true},
                                   {"count", 4},
                                   {"type", "VEC3"}});
    m.root["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 2}}}, {"indices", 1}}}}}};
    const SceneDesc scene = parse(m);
    EXPECT_EQ(sorted(mesh_of(scene)), sorted(mesh_of(parse(square())))) << as_triangles;
    // 8 bits of an octahedron are within a degree.
    EXPECT_LT(mesh_of(scene).normals[1].x, -0.999f);
    EXPECT_GT(mesh_of(scene).normals[2].y, 0.999f);
  }
}

TEST(GltfCompressed, Draco) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const std::uint32_t corners[2][3] = {{0, 1, 2}, {0, 2, 3}};
  const float uvs[4][2] = {{0, 0}, {0.25f, 0}, {0.25f, 0.5f}, {0, 0.5f}};
  for (std::uint32_t f = 0; f < 2; ++f) {
    const auto* c = corners[f];
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(f), &kSquare[3 * c[0]], &kSquare[3 * c[1]],
                                      &kSquare[3 * c[2]]);
    builder.SetAttributeValuesForFace(uv, draco::FaceIndex(f), uvs[c[0]], uvs[c[1]], uvs[c[2]]);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  ASSERT_TRUE(mesh);
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());

  GltfMaker plain = square();
  plain.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      plain.accessor("VEC2", std::vector<float>{0, 0, 0.25f, 0, 0.25f, 0.5f, 0, 0.5f});
  GltfMaker m;
  const int view = m.view(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
  m.root["accessors"] = {{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                         {{"componentType", 5126}, {"count", 4}, {"type", "VEC2"}},
                         {{"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}};
  m.root["meshes"] = {{{"primitives",
                        {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}},
                          {"indices", 2},
                          {"extensions",
                           {{"KHR_draco_mesh_compression",
                             {{"bufferView", view},
                              {"attributes",
                               {{"POSITION", mesh->attribute(position)->unique_id()},
                                {"TEXCOORD_0", mesh->attribute(uv)->unique_id()}}}}}}}}}}}};
  EXPECT_EQ(sorted(mesh_of(parse(m))), sorted(mesh_of(parse(plain))));

  // Cut short, or lying about its size.
  m.root["bufferViews"][0]["byteLength"] = buffer.size() / 2;
  EXPECT_NE(failure(m.gltf()).find("KHR_draco_mesh_compression"), std::string::npos) << failure(m.gltf());
  m.root["bufferViews"][0]["byteLength"] = buffer.size();
  m.root["accessors"][0]["count"] = 5;
  EXPECT_NE(failure(m.gltf()).find("holds 4 vertices"), std::string::npos) << failure(m.gltf());
}

}  // namespace
}  // namespace lumirank::scenedesc
