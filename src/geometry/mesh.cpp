#include "geometry/mesh.h"

#include <cstring>
#include <type_traits>
#include <utility>

namespace lumirank::geometry {

Vec3f TriangleMesh::area_vector(std::size_t triangle) const {
  const std::uint32_t* corner = &indices[3 * triangle];
  const Vec3f a = positions[corner[0]];
  return cross(positions[corner[1]] - a, positions[corner[2]] - a);
}

Bounds3f TriangleMesh::bounds() const {
  Bounds3f box = fibers.bounds();
  for (const Vec3f& p : positions) box.extend(p);
  return box;
}

namespace {

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  static_assert(std::is_trivially_copyable_v<T>);
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace

bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return same_bits(a.positions, b.positions) && same_bits(a.normals, b.normals) && same_bits(a.uvs, b.uvs) &&
         same_bits(a.colors, b.colors) && same_bits(a.indices, b.indices) &&
         same_bits(a.fibers.points, b.fibers.points) && same_bits(a.fibers.parameter, b.fibers.parameter) &&
         same_bits(a.fibers.segments, b.fibers.segments) && a.fibers.smooth == b.fibers.smooth;
}

SharedMesh share_mesh(TriangleMesh mesh) {
  mesh.positions.reserve(mesh.positions.size() + 1);  // Embree reads 16 bytes at the last vertex
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

}  // namespace lumirank::geometry
