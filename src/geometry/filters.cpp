// Called by Embree at hits on fibers and on surfaces that do not simply block. A filter may be called more
// than once for the same crossing, and in any order, so what it decides is a function of the crossing alone.
#include "base/random.h"
#include "geometry/ray_scene_impl.h"

namespace lumirank::geometry {
namespace {

Hit hit_of(const RTCFilterFunctionNArguments& a, unsigned lane, const RayScene::Impl& scene) {
  Hit hit;
  hit.t = RTCRayN_tfar(a.ray, a.N, lane);
  hit.instance = scene.placement_of(RTCHitN_instID(a.hit, a.N, lane, 0), RTCHitN_geomID(a.hit, a.N, lane));
  hit.mesh = scene.placements[hit.instance].mesh;
  hit.triangle = RTCHitN_primID(a.hit, a.N, lane);
  hit.barycentric = {RTCHitN_u(a.hit, a.N, lane), RTCHitN_v(a.hit, a.N, lane)};
  return hit;
}

// Embree rounds both ends of every segment, by its radius there. What of that lies over the next segment's
// own strip, or beyond the end of the curve, belongs to no part of the fiber's length: light along a fiber
// would meet more of it than light from the side knows of, and a ray that leaves the axis would be caught in
// the cap of the segment ahead, so that paths would differ by the end from which they are traced. What
// remains is the wedge that a bend leaves open on its outer side.
bool is_spurious(const RTCFilterFunctionNArguments& a, unsigned lane) {
  const float u = RTCHitN_u(a.hit, a.N, lane);
  if (u > 0 && u < 1) return false;
  const auto& traced = *static_cast<const TracedFibers*>(a.geometryUserPtr);
  const Fibers& fibers = *traced.fibers;
  const std::uint32_t segment = RTCHitN_primID(a.hit, a.N, lane), first = fibers.segments[segment];
  if (u <= 0 ? !fibers.follows(segment) : !fibers.goes_on(segment)) return true;
  const Vec3f joint = traced.points[u <= 0 ? first : first + 1].position;
  const Vec3f next = traced.points[u <= 0 ? first - 1 : first + 2].position - joint;
  const Vec3f d{RTCRayN_dir_x(a.ray, a.N, lane), RTCRayN_dir_y(a.ray, a.N, lane),
                RTCRayN_dir_z(a.ray, a.N, lane)};
  const Vec3f to_ray = Vec3f{RTCRayN_org_x(a.ray, a.N, lane), RTCRayN_org_y(a.ray, a.N, lane),
                             RTCRayN_org_z(a.ray, a.N, lane)} -
                       joint;
  // Seen along the ray, it passes beside the next segment and not behind the joint.
  return dot(to_ray - d * (dot(to_ray, d) / dot(d, d)), next) > 0;
}

}  // namespace

void filter_fiber_caps(const RTCFilterFunctionNArguments* arguments) {
  const RTCFilterFunctionNArguments& a = *arguments;
  if (!a.geometryUserPtr) return;
  for (unsigned lane = 0; lane < a.N; ++lane)
    if (a.valid[lane] && is_spurious(a, lane)) a.valid[lane] = 0;
}

void filter_cutout(const RTCFilterFunctionNArguments* arguments) {
  filter_fiber_caps(arguments);
  const RTCFilterFunctionNArguments& a = *arguments;
  const auto& query = *reinterpret_cast<const QueryContext*>(a.context);
  for (unsigned lane = 0; lane < a.N; ++lane) {
    if (!a.valid[lane]) continue;
    const Hit hit = hit_of(a, lane, *query.scene);
    const std::uint64_t id = (static_cast<std::uint64_t>(hit.instance) << 32) | hit.triangle;
    const std::uint64_t key = query.packet ? query.packet->key(RTCRayN_id(a.ray, a.N, lane)) : query.key;
    const float threshold = unit_float(hash_ids(0, Stage::opacity, key, id));
    if (!(threshold < query.callbacks->opacity(hit))) a.valid[lane] = 0;
  }
}

void filter_attenuating(const RTCFilterFunctionNArguments* arguments) {
  filter_fiber_caps(arguments);
  const RTCFilterFunctionNArguments& a = *arguments;
  const auto& query = *reinterpret_cast<const QueryContext*>(a.context);
  if (!query.crossed) return;  // asked only whether there is anything: let the hit count
  for (unsigned lane = 0; lane < a.N; ++lane) {
    if (!a.valid[lane]) continue;
    query.crossed->push_back(hit_of(a, lane, *query.scene));
    a.valid[lane] = 0;
  }
}

}  // namespace lumirank::geometry
