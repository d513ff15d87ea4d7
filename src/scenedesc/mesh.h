// Triangle meshes as read from files: the plain data that geometry is built from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::scenedesc {

struct MeshData {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;          // empty or one per position
  std::vector<Vec2f> uvs;              // empty or one per position
  std::vector<Rgb> colors;             // empty or one per position
  std::vector<std::uint32_t> indices;  // three per triangle, each < positions.size()
  // What the reader mended or left out, for the warnings: "12 degenerate triangles left out", …
  std::vector<std::string> notes;

  std::size_t triangle_count() const { return indices.size() / 3; }
};

}  // namespace lumirank::scenedesc
