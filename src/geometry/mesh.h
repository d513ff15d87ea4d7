// Meshes ready for tracing.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/bounds.h"
#include "base/prefetch.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "geometry/fibers.h"

namespace lumirank::geometry {

struct TriangleMesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  // empty (flat shading) or one per position, unit length
  std::vector<Vec2f> uvs;      // empty or one per position
  std::vector<Rgb> colors;     // empty or one per position
  std::vector<std::uint32_t> indices;
  Fibers fibers;  // if it has any, the mesh consists of them and has no triangles

  bool empty() const { return indices.empty() && fibers.empty(); }
  std::size_t primitive_count() const { return triangle_count() + fibers.segments.size(); }
  std::size_t triangle_count() const { return indices.size() / 3; }
  // Twice the area times the unit normal, by the order of the corners.
  Vec3f area_vector(std::size_t triangle) const;
  Bounds3f bounds() const;

  // Asks memory for what a triangle needs: its indices, and when these are there its corners.
  void fetch_indices(std::size_t triangle) const {
    if (!indices.empty()) prefetch(&indices[3 * triangle]);
  }
  void fetch_corners(std::size_t triangle) const {
    if (indices.empty()) return;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = indices[3 * triangle + k];
      prefetch(&positions[i]);
      if (!normals.empty()) prefetch(&normals[i]);
      if (!uvs.empty()) prefetch(&uvs[i]);
    }
  }
};

// Same in every bit that tracing and shading read.
bool same_mesh(const TriangleMesh& a, const TriangleMesh& b);

// A mesh that several scenes may hold, with the room that Embree reads beyond its last vertex.
using SharedMesh = std::shared_ptr<const TriangleMesh>;
SharedMesh share_mesh(TriangleMesh mesh);

}  // namespace lumirank::geometry
