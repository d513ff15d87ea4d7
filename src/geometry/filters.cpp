// Called by Embree at hits on surfaces that do not simply block. A filter may be called more than once for
// the same crossing, and in any order, so what it decides is a function of the crossing alone.
#include "base/random.h"
#include "geometry/ray_scene_impl.h"

namespace lumirank::geometry {
namespace {

Hit hit_of(const RTCFilterFunctionNArguments& a, unsigned lane, const RayScene::Impl& scene) {
  const unsigned instance = RTCHitN_instID(a.hit, a.N, lane, 0);
  Hit hit;
  hit.t = RTCRayN_tfar(a.ray, a.N, lane);
  hit.instance = instance != RTC_INVALID_GEOMETRY_ID ? instance : RTCHitN_geomID(a.hit, a.N, lane);
  hit.mesh = scene.placements[hit.instance].mesh;
  hit.triangle = RTCHitN_primID(a.hit, a.N, lane);
  hit.barycentric = {RTCHitN_u(a.hit, a.N, lane), RTCHitN_v(a.hit, a.N, lane)};
  return hit;
}

}  // namespace

void filter_cutout(const RTCFilterFunctionNArguments* arguments) {
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

void filter_smooth(const RTCFilterFunctionNArguments* arguments) {
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
