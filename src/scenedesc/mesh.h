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
  // What was left out without a trace in any picture: "12 degenerate triangles".
  std::vector<std::string> left_out;
  // What was mended, so that a picture may show it: "3 texture coordinates that are not finite", by "0".
  struct Mended {
    std::string what, used_instead;
    friend bool operator==(const Mended&, const Mended&) = default;
  };
  std::vector<Mended> mended;

  std::size_t triangle_count() const { return indices.size() / 3; }
};

}  // namespace lumirank::scenedesc
