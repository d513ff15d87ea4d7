// Building the acceleration structures.
#include <map>
#include <utility>

#include "base/error.h"
#include "geometry/ray_scene_impl.h"

namespace lumirank::geometry {
namespace {

void on_error(void* user, RTCError, const char* message) {
  auto& first = *static_cast<std::string*>(user);
  if (first.empty()) first = message ? message : "unknown error";
}

bool on_memory(void* user, ssize_t bytes, bool) {
  static_cast<std::atomic<long long>*>(user)->fetch_add(bytes, std::memory_order_relaxed);
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

[[noreturn]] void out_of_memory() {
  throw InputError("the scene does not fit into memory", "use fewer triangles or instances");
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

}  // namespace

void RayScene::Impl::open_device() {
#if defined(__SANITIZE_THREAD__)
  // Embree's own threads are out of this sanitizer's sight, and on_memory would be called from them.
  device.reset(rtcNewDevice("threads=1"));
#else
  device.reset(rtcNewDevice(nullptr));
#endif
  if (!device)
    throw InternalError("Embree does not start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  rtcSetDeviceErrorFunction(device.get(), on_error, &first_error);
  rtcSetDeviceMemoryMonitorFunction(device.get(), on_memory, &bytes);
}

embree::Scene RayScene::Impl::new_scene() {
  embree::Scene scene(rtcNewScene(device.get()));
  // Measured on two interiors (66 and 143 thousand triangles): HIGH traces shadow packets 7-30 % faster than
  // MEDIUM and takes 0.1 s more to build.
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
  return scene;
}

void RayScene::Impl::commit(RTCScene scene) {
  rtcCommitScene(scene);
  const RTCError code = rtcGetDeviceError(device.get());
  if (code == RTC_ERROR_OUT_OF_MEMORY) out_of_memory();
  if (code != RTC_ERROR_NONE || !first_error.empty()) throw InternalError("Embree: " + first_error);
}

// With `baked`, a copy of the vertices in world space; otherwise the mesh's own arrays.
embree::Geometry RayScene::Impl::triangles_of(const TriangleMesh& mesh, const Transform* baked) {
  embree::Geometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
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

embree::Geometry RayScene::Impl::fibers_of(const Fibers& fibers, const Transform* baked) {
  embree::Geometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE));
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

embree::Geometry RayScene::Impl::geometry_of(const TriangleMesh& mesh, const Transform* baked,
                                             Blocking blocking_kind) {
  embree::Geometry geometry = mesh.fibers.empty() ? triangles_of(mesh, baked) : fibers_of(mesh.fibers, baked);
  if (blocking_kind == Blocking::cutout)
    rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_cutout);
  else if (blocking_kind == Blocking::attenuating)
    rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_attenuating);
  rtcCommitGeometry(geometry.get());
  return geometry;
}

embree::Scene RayScene::Impl::build_part(std::uint32_t mesh, Blocking blocking_kind) {
  embree::Scene part = new_scene();
  rtcAttachGeometry(part.get(), geometry_of(meshes[mesh], nullptr, blocking_kind).get());
  commit(part.get());
  return part;
}

void RayScene::Impl::build(std::size_t flatten_limit) {
  std::vector<std::size_t> copies(meshes.size());
  std::size_t primitives = 0;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    validate(meshes[k], k);
    // Embree reads 16 bytes at the last vertex.
    meshes[k].positions.reserve(meshes[k].positions.size() + 1);
  }
  for (std::size_t k = 0; k < placements.size(); ++k) {
    const Placement& p = placements[k];
    if (p.mesh >= meshes.size()) throw InternalError("placement " + std::to_string(k) + ": no such mesh");
    if (!is_affine(p.to_world))
      throw InputError("the transform of placement " + std::to_string(k) + " is not affine or not finite",
                       "use translations, rotations, scales and shears only");
    ++copies[p.mesh];
    primitives += meshes[p.mesh].primitive_count();
  }
  if (primitives == 0) throw InputError("the scene has no triangle", "add a shape");

  open_device();
  std::map<std::pair<std::uint32_t, Blocking>, RTCScene> part_of;
  for (std::size_t k = 0; k < placements.size(); ++k) {
    const Placement& p = placements[k];
    const TriangleMesh& mesh = meshes[p.mesh];
    if (mesh.empty()) continue;
    if (!mesh.fibers.empty()) run_up = std::max(run_up, 2.1f * widest_radius(mesh.fibers, p.to_world));
    embree::Scene& top = p.blocking == Blocking::attenuating ? attenuating : blocking;
    if (!top) top = new_scene();
    const auto id = static_cast<unsigned>(k);
    const std::optional<Transform> inverse = p.to_world.inverse();
    // A transform that flattens the mesh cannot be undone on rays, so it must be applied to the vertices.
    if (p.to_world.is_identity() || !inverse || copies[p.mesh] == 1 ||
        copies[p.mesh] * mesh.primitive_count() <= flatten_limit) {
      const bool moved = !p.to_world.is_identity();
      rtcAttachGeometryByID(top.get(), geometry_of(mesh, moved ? &p.to_world : nullptr, p.blocking).get(),
                            id);
      continue;
    }
    RTCScene& part = part_of[{p.mesh, p.blocking}];
    if (!part) {
      parts.push_back(build_part(p.mesh, p.blocking));
      part = parts.back().get();
    }
    embree::Geometry instance(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(instance.get(), part);
    float rows[12];
    for (int i = 0; i < 12; ++i) rows[i] = static_cast<float>(p.to_world.m[i]);
    rtcSetGeometryTransform(instance.get(), 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
    rtcCommitGeometry(instance.get());
    rtcAttachGeometryByID(top.get(), instance.get(), id);
  }
  if (!blocking) blocking = new_scene();
  for (RTCScene scene : {blocking.get(), attenuating.get()}) {
    if (!scene) continue;
    commit(scene);
    RTCBounds box;
    rtcGetSceneBounds(scene, &box);
    bounds.extend(Bounds3f{{box.lower_x, box.lower_y, box.lower_z}, {box.upper_x, box.upper_y, box.upper_z}});
  }
}

}  // namespace lumirank::geometry
