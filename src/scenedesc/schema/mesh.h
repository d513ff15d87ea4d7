// Triangle meshes as read from files: the plain data that geometry is built from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::scenedesc {

struct MeshData {
  std::vector<Vec3f> positions;        // relative to `origin`
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
  // Not zero where the mesh is so far from its file's origin that 32 bits would lose what the file says.
  Vec3d origin;

  std::size_t triangle_count() const { return indices.size() / 3; }
};

// From how many of its radii on a mesh gets an origin of its own. Rounding then moves corners by less than
// 2⁻¹⁸ of its radius, a tenth of the step by which rays leave surfaces (world::World::offset_origin).
inline constexpr double kFarMesh = 64;

// Positions as the file has them → those of a mesh, and its origin.
struct NearPositions {
  std::vector<Vec3f> positions;
  Vec3d origin;
};
NearPositions near_positions(const std::vector<Vec3d>& places);

}  // namespace lumirank::scenedesc
