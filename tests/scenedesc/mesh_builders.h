// Mesh files written by the tests themselves.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace lumirank::scenedesc {

template <typename T>
void put(std::string& out, T value, bool big_endian = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof raw);
  if (big_endian) std::reverse(raw, raw + sizeof raw);
  out.append(raw, sizeof raw);
}

inline std::string deflated(const std::string& plain) {
  uLongf size = compressBound(plain.size());
  std::string out(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(plain.data()),
               plain.size()) != Z_OK)
    throw std::runtime_error("compress");
  out.resize(size);
  return out;
}

// The plain content of one serialized mesh.
struct SerializedMesh {
  std::uint32_t flags = 0x1000;
  std::string name = "part";
  std::vector<double> positions{0, 0, 0, 1, 0, 0, 0, 1, 0}, normals, uvs, colors;
  std::vector<std::uint32_t> indices{0, 1, 2};
  std::uint64_t claimed_vertices = 0, claimed_triangles = 0;  // 0: the truth

  std::string plain(int version) const {
    std::string out;
    const std::uint32_t all =
        flags | (normals.empty() ? 0 : 1) | (uvs.empty() ? 0 : 2) | (colors.empty() ? 0 : 8);
    put(out, all);
    if (version == 4) out.append(name.c_str(), name.size() + 1);
    put<std::uint64_t>(out, claimed_vertices ? claimed_vertices : positions.size() / 3);
    put<std::uint64_t>(out, claimed_triangles ? claimed_triangles : indices.size() / 3);
    for (const std::vector<double>* values : {&positions, &normals, &uvs, &colors})
      for (const double v : *values) {
        if (flags & 0x2000)
          put(out, v);
        else
          put(out, static_cast<float>(v));
      }
    for (const std::uint32_t i : indices) put(out, i);
    return out;
  }
};

inline std::string serialized_file(const std::vector<SerializedMesh>& meshes, int version) {
  std::string out;
  std::vector<std::size_t> offsets;
  for (const SerializedMesh& m : meshes) {
    offsets.push_back(out.size());
    put<std::uint16_t>(out, 0x041C);
    put<std::uint16_t>(out, static_cast<std::uint16_t>(version));
    out += deflated(m.plain(version));
  }
  for (const std::size_t o : offsets) {
    if (version == 4)
      put<std::uint64_t>(out, o);
    else
      put<std::uint32_t>(out, static_cast<std::uint32_t>(o));
  }
  put<std::uint32_t>(out, static_cast<std::uint32_t>(meshes.size()));
  return out;
}

}  // namespace lumirank::scenedesc
