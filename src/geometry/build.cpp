// Building the acceleration structures.
#include <algorithm>
#include <utility>

#include "base/error.h"
#include "geometry/ray_scene_impl.h"

namespace lumirank::geometry {
namespace {

void on_error(void* user, RTCError, const char* message) {
  auto& first = static_cast<TracingDevice*>(user)->first_error;
  if (first.empty()) first = message ? message : "unknown error";
}

bool on_memory(void* user, ssize_t bytes, bool) {
  static_cast<TracingDevice*>(user)->bytes.fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

void validate(const TriangleMesh& mesh, std::size_t k) {
  const std::string name = "mesh " + std::to_string(k);
  const std::size_t n = mesh.positions.size();
  if (mesh.indices.size() % 3 != 0)
    throw InternalError(name + ": the number of indices is not a multiple of 3");
  for (const std::uint32_t i : mesh.indices)
    if (i >= n)
      throw InternalError(name + ": index " + std::to_string(i) + " of " + std::to_string(n) + " vertices");
  for (const std::size_t size : {mesh.normals.size(), mesh.uvs.size(), mesh.colors.size()})
    if (size != 0 && size != n) throw InternalError(name + ": a vertex attribute has the wrong length");
  if (!mesh.fibers.empty() && !mesh.indices.empty())
    throw InternalError(name + ": both triangles and fibers");
  if (mesh.fibers.parameter.size() != mesh.fibers.points.size())
    throw InternalError(name + ": the fibers' parameters have the wrong length");
  for (const std::uint32_t i : mesh.fibers.segments)
    if (i + std::size_t{1} >= mesh.fibers.points.size())
      throw InternalError(name + ": a segment without an end");
}

// In world space. An instance keeps its radii and turns rays into its own space, so what counts is by how
// much it lengthens most; what has been moved has its radii changed as Fibers::transform() says, which is
// less.
float widest_radius(const Fibers& fibers, const Transform& to_world) {
  float widest = 0;
  for (const Fibers::Point& p : fibers.points) widest = std::max(widest, p.radius);
  float squares = 0;
  for (const Vec3f& axis : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}})
    squares += length_squared(to_world.vector(axis));
  return to_world.is_identity() ? widest : widest * std::sqrt(squares);
}

bool is_affine(const Transform& t) {
  return t.m[12] == 0 && t.m[13] == 0 && t.m[14] == 0 && t.m[15] == 1 && t.is_finite();
}

std::shared_ptr<TracingDevice> open_device() {
  auto device = std::make_shared<TracingDevice>();
#if defined(__SANITIZE_THREAD__)
  // Embree's own threads are out of this sanitizer's sight, and on_memory would be called from them.
  device->handle.reset(rtcNewDevice("threads=1"));
#else
  device->handle.reset(rtcNewDevice(nullptr));
#endif
  if (!device->handle)
    throw InternalError("Embree does not start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  rtcSetDeviceErrorFunction(device->handle.get(), on_error, device.get());
  rtcSetDeviceMemoryMonitorFunction(device->handle.get(), on_memory, device.get());
  return device;
}

// With `baked`, a copy of the vertices in world space; otherwise the mesh's own arrays.
embree::Geometry triangles_of(RTCDevice device, const TriangleMesh& mesh, const Transform* baked) {
  embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  const std::size_t n = mesh.positions.size();
  if (baked) {
    auto* out = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                            RTC_FORMAT_FLOAT3, sizeof(Vec3f), n));
    if (!out) out_of_memory();
    for (std::size_t k = 0; k < n; ++k) out[k] = baked->point(mesh.positions[k]);
  } else {
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.positions.data(), 0, sizeof(Vec3f), n);
  }
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(),
                             0, 3 * sizeof(std::uint32_t), mesh.triangle_count());
  return geometry;
}

embree::Geometry fibers_of(RTCDevice device, const Fibers& fibers, const Transform* baked,
                           std::deque<TracedFibers>& traced) {
  embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE));
  const std::size_t n = fibers.points.size();
  const Fibers::Point* points = fibers.points.data();
  if (baked) {
    auto* out = static_cast<Fibers::Point*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(Fibers::Point), n));
    if (!out) out_of_memory();
    Fibers moved = fibers;
    moved.transform(*baked);
    std::copy(moved.points.begin(), moved.points.end(), out);
    points = out;
  } else {
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                               fibers.points.data(), 0, sizeof(Fibers::Point), n);
  }
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                             fibers.segments.data(), 0, sizeof(std::uint32_t), fibers.segments.size());
  traced.push_back({&fibers, points});
  rtcSetGeometryUserData(geometry.get(), &traced.back());
  rtcSetGeometryIntersectFilterFunction(geometry.get(), filter_fiber_caps);
  rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_fiber_caps);
  return geometry;
}

}  // namespace

void out_of_memory() {
  throw InputError("the scene does not fit into memory", "use fewer triangles or instances");
}

void set_filters(RTCGeometry geometry, Blocking blocking) {
  if (blocking == Blocking::cutout)
    rtcSetGeometryOccludedFilterFunction(geometry, filter_cutout);
  else if (blocking == Blocking::attenuating)
    rtcSetGeometryOccludedFilterFunction(geometry, filter_attenuating);
}

void TracedPart::add_mesh(const SharedMesh& mesh, const Transform* baked, Blocking blocking, unsigned id) {
  meshes.push_back(mesh);
  RTCDevice handle = device->handle.get();
  const embree::Geometry geometry = mesh->fibers.empty() ? triangles_of(handle, *mesh, baked)
                                                         : fibers_of(handle, mesh->fibers, baked, fibers);
  set_filters(geometry.get(), blocking);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene.get(), geometry.get(), id);
}

void TracedPart::add_instance(const std::shared_ptr<const TracedPart>& part, const Transform& to_world,
                              unsigned id) {
  instanced.push_back(part);
  const embree::Geometry instance(rtcNewGeometry(device->handle.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(instance.get(), part->scene.get());
  float rows[12];
  for (int i = 0; i < 12; ++i) rows[i] = static_cast<float>(to_world.m[i]);
  rtcSetGeometryTransform(instance.get(), 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
  rtcCommitGeometry(instance.get());
  rtcAttachGeometryByID(scene.get(), instance.get(), id);
}

void TracedPart::commit() {
  rtcCommitScene(scene.get());
  const RTCError code = rtcGetDeviceError(device->handle.get());
  if (code == RTC_ERROR_OUT_OF_MEMORY) out_of_memory();
  if (code != RTC_ERROR_NONE || !device->first_error.empty())
    throw InternalError("Embree: " + device->first_error);
}

std::shared_ptr<TracedPart> RayScene::Impl::new_part() const {
  auto part = std::make_shared<TracedPart>();
  part->device = device;
  part->scene.reset(rtcNewScene(device->handle.get()));
  // Measured on two interiors (66 and 143 thousand triangles): HIGH traces shadow packets 7-30 % faster than
  // MEDIUM and takes 0.1 s more to build.
  rtcSetSceneBuildQuality(part->scene.get(), RTC_BUILD_QUALITY_HIGH);
  return part;
}

void RayScene::Impl::add_flat(TracedPart& to, std::size_t placement) const {
  const Placement& p = placements[placement];
  to.add_mesh(meshes[p.mesh], p.to_world.is_identity() ? nullptr : &p.to_world, p.blocking,
              static_cast<unsigned>(placement));
}

SharedPart RayScene::Impl::instanced_part(std::uint32_t mesh, Blocking blocking_kind, const Impl* before) {
  SharedPart& part = parts[{mesh, blocking_kind}];
  if (part) return part;
  if (before && mesh < before->meshes.size() && before->meshes[mesh] == meshes[mesh])
    if (const auto found = before->parts.find({mesh, blocking_kind}); found != before->parts.end())
      return part = found->second;
  const auto made = new_part();
  made->add_mesh(meshes[mesh], nullptr, blocking_kind, 0);
  made->commit();
  return part = made;
}

void RayScene::Impl::check() const {
  std::size_t primitives = 0;
  for (std::size_t k = 0; k < meshes.size(); ++k) validate(*meshes[k], k);
  for (std::size_t k = 0; k < placements.size(); ++k) {
    const Placement& p = placements[k];
    if (p.mesh >= meshes.size()) throw InternalError("placement " + std::to_string(k) + ": no such mesh");
    if (!is_affine(p.to_world))
      throw InputError("the transform of placement " + std::to_string(k) + " is not affine or not finite",
                       "use translations, rotations, scales and shears only");
    primitives += meshes[p.mesh]->primitive_count();
  }
  if (primitives == 0) throw InputError("the scene has no triangle", "add a shape");
}

void RayScene::Impl::choose_flat(std::size_t flatten_limit) {
  std::vector<std::size_t> copies(meshes.size());
  for (const Placement& p : placements) ++copies[p.mesh];
  for (const Placement& p : placements)
    // A transform that flattens the mesh cannot be undone on rays, so it must be applied to the vertices.
    flat.push_back(p.to_world.is_identity() || !p.to_world.inverse() || copies[p.mesh] == 1 ||
                   copies[p.mesh] * meshes[p.mesh]->primitive_count() <= flatten_limit);
}

std::vector<bool> RayScene::Impl::same_as(const Impl* before) const {
  std::vector<bool> same(placements.size(), false);
  if (!before || before->placements.size() != placements.size() || before->meshes.size() != meshes.size())
    return same;
  for (std::size_t k = 0; k < placements.size(); ++k) {
    const Placement &now = placements[k], &then = before->placements[k];
    same[k] = now.mesh == then.mesh && meshes[now.mesh] == before->meshes[then.mesh] &&
              now.to_world == then.to_world && now.blocking == then.blocking && flat[k] == before->flat[k];
  }
  return same;
}

// What was still up to now is kept if it still is, so that all moments of a shot share one structure.
void RayScene::Impl::share_still(const Impl* before, const std::vector<bool>& same, std::size_t share_limit) {
  if (!before) return;
  bool kept = !before->still.holds.empty();
  std::size_t primitives = 0;
  std::vector<bool> holds(placements.size());
  for (std::size_t k = 0; k < placements.size(); ++k) {
    holds[k] = same[k] && flat[k];
    if (holds[k]) primitives += meshes[placements[k].mesh]->primitive_count();
    kept = kept && (same[k] || !before->still.holds[k]);
  }
  if (kept) {
    still = before->still;
    return;
  }
  if (primitives == 0 || primitives < share_limit) return;
  std::shared_ptr<TracedPart> made[2];
  for (std::size_t k = 0; k < placements.size(); ++k) {
    if (!holds[k] || meshes[placements[k].mesh]->empty()) continue;
    auto& part = made[placements[k].blocking == Blocking::attenuating];
    if (!part) part = new_part();
    add_flat(*part, k);
  }
  for (const auto& part : made)
    if (part) part->commit();
  still = {std::move(holds), made[0], made[1]};
}

void RayScene::Impl::build(std::size_t flatten_limit, const Sharing& sharing) {
  const Impl* before = sharing.before ? sharing.before->impl_.get() : nullptr;
  check();
  choose_flat(flatten_limit);
  for (const Placement& p : placements)
    if (const Fibers& fibers = meshes[p.mesh]->fibers; !fibers.empty())
      run_up = std::max(run_up, 2.1f * widest_radius(fibers, p.to_world));
  const std::vector<bool> same = same_as(before);
  device = before ? before->device : open_device();
  if (std::all_of(same.begin(), same.end(), [](bool s) { return s; })) {
    parts = before->parts, still = before->still, refitted = before->refitted;
    blocking = before->blocking, attenuating = before->attenuating, bounds = before->bounds;
    return;
  }
  const long long bytes_before = device->bytes;
  share_still(before, same, sharing.least);
  if (before && sharing.refit) refit(*before, same, sharing.least);
  std::shared_ptr<TracedPart> top[2] = {new_part(), nullptr};  // what blocks, what attenuates
  const auto top_for = [&](bool attenuates) -> TracedPart& {
    if (!top[attenuates]) top[attenuates] = new_part();
    return *top[attenuates];
  };
  for (std::size_t k = 0; k < placements.size(); ++k) {
    const Placement& p = placements[k];
    if (meshes[p.mesh]->empty() || (!still.holds.empty() && still.holds[k])) continue;
    TracedPart& to = top_for(p.blocking == Blocking::attenuating);
    if (const auto found = refitted.find(k); found != refitted.end())
      to.add_instance(found->second.part, Transform{}, static_cast<unsigned>(k));
    else if (flat[k])
      add_flat(to, k);
    else
      to.add_instance(instanced_part(p.mesh, p.blocking, before), p.to_world, static_cast<unsigned>(k));
  }
  const auto after_last = static_cast<unsigned>(placements.size());
  if (still.blocking) top_for(false).add_instance(still.blocking, Transform{}, after_last);
  if (still.attenuating) top_for(true).add_instance(still.attenuating, Transform{}, after_last);
  for (const auto& part : top) {
    if (!part) continue;
    part->commit();
    RTCBounds box;
    rtcGetSceneBounds(part->scene.get(), &box);
    bounds.extend(Bounds3f{{box.lower_x, box.lower_y, box.lower_z}, {box.upper_x, box.upper_y, box.upper_z}});
  }
  blocking = top[0], attenuating = top[1];
  own_bytes = device->bytes - bytes_before;
}

}  // namespace lumirank::geometry
