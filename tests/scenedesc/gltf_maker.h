// Small glTF files made by the tests themselves: a JSON object and the bytes that its bufferViews name.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "scenedesc/readers.h"

namespace lumirank::scenedesc {

inline std::string base64(const std::string& bytes) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (k + i < bytes.size() ? static_cast<unsigned char>(bytes[k + i]) : 0u);
    for (std::size_t i = 0; i < 4; ++i)
      out += k + i > bytes.size() ? '=' : letters[group >> (18 - 6 * i) & 63];
  }
  return out;
}

struct GltfMaker {
  using json = nlohmann::json;
  json root = {{"asset", {{"version", "2.0"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", json::array({0})}}}},
               {"nodes", {{{"mesh", 0}}}},
               {"buffers", json::array()},
               {"bufferViews", json::array()},
               {"accessors", json::array()}};
  std::string bytes;

  template <typename T>
  int view(const std::vector<T>& values, int stride = 0) {
    while (bytes.size() % 4 != 0) bytes += '\0';
    json made = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride > 0) made["byteStride"] = stride;
    root["bufferViews"].push_back(made);
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }
  template <typename T>
  int accessor(const std::string& type, const std::vector<T>& values, bool normalized = false) {
    const std::size_t components = type == "SCALAR" ? 1 : (type == "MAT4" ? 16 : type.back() - '0');
    json made = {{"bufferView", view(values)},
                 {"componentType", component_type<T>()},
                 {"count", values.size() / components},
                 {"type", type}};
    if (normalized) made["normalized"] = true;
    root["accessors"].push_back(made);
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  std::string gltf() const {
    json whole = root;
    whole["buffers"] = {
        {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    return whole.dump(1);
  }
  std::string glb() const {
    json whole = root;
    whole["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string text = whole.dump(), binary = bytes;
    while (text.size() % 4 != 0) text += ' ';
    while (binary.size() % 4 != 0) binary += '\0';
    std::string out = "glTF" + word(2) + word(static_cast<std::uint32_t>(28 + text.size() + binary.size()));
    out += word(static_cast<std::uint32_t>(text.size())) + "JSON" + text;
    out += word(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
    return out;
  }
  static std::string word(std::uint32_t value) {
    std::string out(4, '\0');
    for (int k = 0; k < 4; ++k) out[static_cast<std::size_t>(k)] = static_cast<char>(value >> 8 * k & 255);
    return out;
  }

 private:
  template <typename T>
  static int component_type() {
    if (std::is_same_v<T, float>) return 5126;
    if (std::is_same_v<T, std::uint32_t>) return 5125;
    if (std::is_same_v<T, std::uint16_t>) return 5123;
    if (std::is_same_v<T, std::int16_t>) return 5122;
    if (std::is_same_v<T, std::uint8_t>) return 5121;
    return 5120;
  }
};

// The unit square in z = 0 seen from +z, as two triangles of four vertices.
inline const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

// One mesh of one primitive with four vertices and the indices 0 1 2 0 2 3.
inline GltfMaker square() {
  GltfMaker m;
  const int positions = m.accessor("VEC3", kSquare);
  const int indices = m.accessor("SCALAR", std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3});
  m.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}}};
  return m;
}

inline SceneDesc parse(const GltfMaker& maker, const ReadOptions& options = {}) {
  return parse_gltf(maker.gltf(), "made.gltf", options);
}
inline const MeshData& mesh_of(const SceneDesc& scene, std::size_t shape = 0) {
  return *std::get<InlineMeshDesc>(scene.shapes.at(shape).kind).mesh;
}
// The first warning (no note) whose text contains `what`, or null.
inline const Warning* warning_about(const SceneDesc& scene, const std::string& what) {
  for (const Warning& w : scene.warnings)
    if (!w.harmless && w.what.find(what) != std::string::npos) return &w;
  return nullptr;
}
// What parsing says, or "" if it succeeds.
inline std::string failure(const std::string& bytes, const ReadOptions& options = {}) {
  try {
    parse_gltf(bytes, "made.gltf", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace lumirank::scenedesc
