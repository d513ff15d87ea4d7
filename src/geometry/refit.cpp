// Structures that are kept from moment to moment and follow their vertices, instead of being built anew.
#include <algorithm>

#include "geometry/ray_scene_impl.h"

namespace lumirank::geometry {
namespace {

// Each leaves the structure as it was grouped for the first pose, so it gets worse while things bend.
constexpr int kRefitsInARow = 12;

// Fibers are built anew: Embree bounds them in boxes that are turned along them.
bool only_vertices_differ(const TriangleMesh& a, const TriangleMesh& b) {
  return a.fibers.empty() && b.fibers.empty() && a.positions.size() == b.positions.size() &&
         a.indices == b.indices;
}

void set_vertices(const RefittedPart& to, const TriangleMesh& mesh, const Transform& to_world) {
  auto* out = static_cast<Vec3f*>(rtcGetGeometryBufferData(to.geometry, RTC_BUFFER_TYPE_VERTEX, 0));
  std::transform(mesh.positions.begin(), mesh.positions.end(), out,
                 [&](const Vec3f& p) { return to_world.point(p); });
  rtcUpdateGeometryBuffer(to.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(to.geometry);
  to.part->commit();
}

}  // namespace

RefittedPart RayScene::Impl::new_refitted(std::size_t placement) const {
  const Placement& p = placements[placement];
  const SharedMesh& mesh = meshes[p.mesh];
  RefittedPart made;
  made.part = new_part();
  // Only scenes of low quality keep one structure per geometry, and only such ones can be refitted.
  rtcSetSceneBuildQuality(made.part->scene.get(), RTC_BUILD_QUALITY_LOW);
  rtcSetSceneFlags(made.part->scene.get(), RTC_SCENE_FLAG_DYNAMIC);
  made.part->meshes.push_back(mesh);  // its indices are read for as long as the part is
  const embree::Geometry geometry(rtcNewGeometry(device->handle.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  made.geometry = geometry.get();
  rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_REFIT);
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->indices.data(),
                             0, 3 * sizeof(std::uint32_t), mesh->triangle_count());
  if (!rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                               mesh->positions.size()))
    out_of_memory();
  set_filters(geometry.get(), p.blocking);
  rtcAttachGeometryByID(made.part->scene.get(), geometry.get(), 0);
  set_vertices(made, *mesh, p.to_world);
  return made;
}

void RayScene::Impl::refit(const Impl& before, const std::vector<bool>& same, std::size_t least) {
  if (before.placements.size() != placements.size()) return;
  for (std::size_t k = 0; k < placements.size(); ++k) {
    const Placement &now = placements[k], &then = before.placements[k];
    const TriangleMesh& mesh = *meshes[now.mesh];
    if (!flat[k] || !before.flat[k] || now.blocking != then.blocking || mesh.primitive_count() < least ||
        (!still.holds.empty() && still.holds[k]) || !only_vertices_differ(mesh, *before.meshes[then.mesh]))
      continue;
    const auto kept = before.refitted.find(k);
    const bool has = kept != before.refitted.end();
    if (same[k]) {
      if (has) refitted[k] = kept->second;
    } else if (has && kept->second.refits < kRefitsInARow) {
      RefittedPart& part = refitted[k] = kept->second;
      ++part.refits;
      set_vertices(part, mesh, now.to_world);
    } else {
      refitted[k] = new_refitted(k);
    }
  }
}

}  // namespace lumirank::geometry
