// Meshes far from their file's origin keep what its numbers say.
#include "base/near_origin.h"
#include "scenedesc/schema/mesh.h"

namespace lumirank::scenedesc {

NearPositions near_positions(const std::vector<Vec3d>& places) {
  Bounds3d box;
  for (const Vec3d& p : places) box.extend(p);
  NearPositions out;
  out.origin = near_origin(box, kFarMesh);
  out.positions.reserve(places.size());
  for (const Vec3d& p : places) out.positions.push_back(static_cast<Vec3f>(p - out.origin));
  return out;
}

}  // namespace lumirank::scenedesc
