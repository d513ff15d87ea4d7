#include "geometry/mesh.h"

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

}  // namespace lumirank::geometry
