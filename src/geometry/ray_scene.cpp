#include "geometry/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "geometry/ray_scene_impl.h"

namespace lumirank::geometry {
namespace {

// The ray with `start` added to all distances along it, and its origin as far behind.
RTCRay to_embree(const Ray& ray, float start) {
  RTCRay r;
  const Vec3f origin = start > 0 ? ray.origin - ray.direction * start : ray.origin;
  r.org_x = origin.x, r.org_y = origin.y, r.org_z = origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = ray.t_min + start, r.tfar = ray.t_max + start;
  r.time = 0, r.mask = 0xffffffffu, r.id = 0, r.flags = 0;
  return r;
}

// Embree's own bound of what it can trace; some builds of it (Debian's) abort beyond, so such rays are
// answered here.
constexpr float kMaxCoordinate = 1.8e18f;

bool can_trace(const RTCRay& r) {
  bool good = true;
  for (const float x : {r.org_x, r.org_y, r.org_z, r.dir_x, r.dir_y, r.dir_z})
    good &= std::abs(x) <= kMaxCoordinate;
  return good && r.tnear >= 0 && r.tnear <= r.tfar;
}

// In units of the ray's direction, see RayScene::Impl::run_up.
float start_of(const RayScene::Impl& scene, Vec3f direction) {
  if (!(scene.run_up > 0)) return 0;
  const float start = scene.run_up / length(direction);
  return std::isfinite(start) ? start : 0.0f;
}

void run_up(const RayScene::Impl& scene, RTCRay16& rays) {
  for (unsigned k = 0; k < 16; ++k) {
    const float start = start_of(scene, {rays.dir_x[k], rays.dir_y[k], rays.dir_z[k]});
    rays.org_x[k] -= rays.dir_x[k] * start;
    rays.org_y[k] -= rays.dir_y[k] * start;
    rays.org_z[k] -= rays.dir_z[k] * start;
    rays.tnear[k] += start, rays.tfar[k] += start;
  }
}

QueryContext context_for(const RayScene::Impl& scene) {
  QueryContext context;
  embree::initialize(context.embree);
  context.callbacks = &scene.callbacks;
  context.scene = &scene;
  return context;
}

// How far across a fiber a ray meets it, see Hit. Radii change with the placement as Fibers::transform()
// says.
float across(const Fibers& fibers, const Transform& to_world, const Hit& hit, const Ray& ray) {
  const FiberPoint at = fiber_point(fibers, hit.triangle, hit.barycentric.x);
  Vec3f axis = at.axis, along = at.along;
  float radius = at.radius;
  if (!to_world.is_identity()) {
    axis = to_world.point(axis), along = to_world.vector(along);
    radius *= static_cast<float>(std::cbrt(std::abs(to_world.determinant3())));
  }
  const Vec3f sideways = cross(along, -ray.direction);
  const float len = length(sideways);
  if (!(len > 0 && radius > 0)) return 0;
  const float y = dot(ray.origin + ray.direction * hit.t - axis, sideways) / (len * radius);
  return std::clamp(y, -1.0f, 1.0f);
}

// Shortens `best` to the closest hit in `scene` before it.
void closest(RTCScene scene, RTCRayHit& best) {
  embree::Context context;
  embree::initialize(context);
  embree::intersect1(scene, context, best);
}

// Bit k: segment k of the packet meets nothing in `scene` that its filters let count.
std::uint16_t unblocked16(RTCScene scene, const ShadowPacket& packet, QueryContext& context) {
  RTCRay16 rays;
  alignas(64) int valid[16];
  std::memcpy(rays.org_x, packet.ox, sizeof packet.ox);
  std::memcpy(rays.org_y, packet.oy, sizeof packet.oy);
  std::memcpy(rays.org_z, packet.oz, sizeof packet.oz);
  std::memcpy(rays.dir_x, packet.dx, sizeof packet.dx);
  std::memcpy(rays.dir_y, packet.dy, sizeof packet.dy);
  std::memcpy(rays.dir_z, packet.dz, sizeof packet.dz);
  for (unsigned k = 0; k < 16; ++k) {
    rays.tnear[k] = kShadowEpsilon;
    rays.tfar[k] = packet.t_far[k] * (1 - kShadowEpsilon);
    rays.time[k] = 0;
    rays.mask[k] = 0xffffffffu;
    rays.id[k] = k;
    rays.flags[k] = 0;
    // Integers and bitwise, so that the loop becomes a few vector instructions.
    const int good =
        int{std::abs(packet.ox[k]) <= kMaxCoordinate} & int{std::abs(packet.oy[k]) <= kMaxCoordinate} &
        int{std::abs(packet.oz[k]) <= kMaxCoordinate} & int{std::abs(packet.dx[k]) <= kMaxCoordinate} &
        int{std::abs(packet.dy[k]) <= kMaxCoordinate} & int{std::abs(packet.dz[k]) <= kMaxCoordinate} &
        int{rays.tfar[k] >= kShadowEpsilon};
    valid[k] = good ? packet.valid[k] : 0;
    // Without AVX-512 Embree takes packets of sixteen apart and looks at lengths alone: what is left out ends
    // before it begins.
    rays.tfar[k] = valid[k] != 0 ? rays.tfar[k] : -1.0f;
  }
  if (context.scene->run_up > 0) run_up(*context.scene, rays);
  embree::occluded16(valid, scene, context.embree, rays, packet.alike && !context.scene->has_instances());
  unsigned visible = 0;
  for (unsigned k = 0; k < 16; ++k) visible |= (unsigned{valid[k] != 0} & unsigned{rays.tfar[k] >= 0}) << k;
  return static_cast<std::uint16_t>(visible);
}

}  // namespace

RayScene::RayScene(std::vector<TriangleMesh> meshes, std::vector<Placement> placements,
                   PassageCallbacks callbacks, std::size_t flatten_limit)
    : impl_(std::make_unique<Impl>()) {
  for (TriangleMesh& mesh : meshes) impl_->meshes.push_back(share_mesh(std::move(mesh)));
  impl_->placements = std::move(placements);
  impl_->callbacks = std::move(callbacks);
  impl_->build(flatten_limit, {});
}
RayScene::RayScene(std::vector<SharedMesh> meshes, std::vector<Placement> placements,
                   PassageCallbacks callbacks, const Sharing& sharing, std::size_t flatten_limit)
    : impl_(std::make_unique<Impl>()) {
  impl_->meshes = std::move(meshes);
  impl_->placements = std::move(placements);
  impl_->callbacks = std::move(callbacks);
  impl_->build(flatten_limit, sharing);
}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

const TriangleMesh& RayScene::mesh(std::size_t k) const { return *impl_->meshes[k]; }
const std::vector<SharedMesh>& RayScene::meshes() const { return impl_->meshes; }
const std::vector<Placement>& RayScene::placements() const { return impl_->placements; }
Bounds3f RayScene::bounds() const { return impl_->bounds; }
bool RayScene::has_attenuating() const { return impl_->attenuating != nullptr; }
std::size_t RayScene::memory_bytes() const { return static_cast<std::size_t>(impl_->own_bytes); }

std::optional<Hit> RayScene::intersect(const Ray& ray) const {
  RTCRayHit query;
  const float start = start_of(*impl_, ray.direction);
  query.ray = to_embree(ray, start);
  if (!can_trace(query.ray)) return std::nullopt;
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  closest(impl_->blocking->scene.get(), query);
  if (impl_->attenuating) closest(impl_->attenuating->scene.get(), query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  Hit hit;
  hit.t = query.ray.tfar - start;
  hit.instance = impl_->placement_of(query.hit.instID[0], query.hit.geomID);
  hit.mesh = impl_->placements[hit.instance].mesh;
  hit.triangle = query.hit.primID;
  hit.barycentric = {query.hit.u, query.hit.v};
  const Fibers& fibers = impl_->meshes[hit.mesh]->fibers;
  if (!fibers.empty()) hit.barycentric.y = across(fibers, impl_->placements[hit.instance].to_world, hit, ray);
  return hit;
}

bool RayScene::occluded(const Ray& ray, std::uint64_t key) const {
  QueryContext context = context_for(*impl_);
  context.key = key;
  RTCRay query = to_embree(ray, start_of(*impl_, ray.direction));
  if (!can_trace(query)) return true;
  embree::occluded1(impl_->blocking->scene.get(), context.embree, query);
  return query.tfar < 0;
}

std::uint16_t RayScene::visible16(const ShadowPacket& packet) const {
  QueryContext context = context_for(*impl_);
  context.packet = &packet;
  return unblocked16(impl_->blocking->scene.get(), packet, context);
}

void RayScene::crossings(const Ray& ray, std::vector<Hit>& out) const {
  out.clear();
  if (!impl_->attenuating) return;
  QueryContext context = context_for(*impl_);
  context.crossed = &out;
  const float start = start_of(*impl_, ray.direction);
  RTCRay query = to_embree(ray, start);
  if (!can_trace(query)) return;
  embree::occluded1(impl_->attenuating->scene.get(), context.embree, query);
  // Neither the order of Embree's traversal nor a triangle reported twice may show in the result.
  std::sort(out.begin(), out.end(), [](const Hit& a, const Hit& b) {
    return std::tie(a.instance, a.t, a.triangle) < std::tie(b.instance, b.t, b.triangle);
  });
  // A ray through the edge between two triangles crosses the surface once.
  out.erase(std::unique(out.begin(), out.end(),
                        [](const Hit& last, const Hit& hit) {
                          return last.instance == hit.instance && hit.t - last.t <= 1e-6f * hit.t;
                        }),
            out.end());
  std::sort(out.begin(), out.end(), [](const Hit& a, const Hit& b) {
    return std::tie(a.t, a.instance, a.triangle) < std::tie(b.t, b.instance, b.triangle);
  });
  for (Hit& hit : out) hit.t -= start;
}

Rgb RayScene::transmittance(const Ray& ray) const {
  Rgb product(1);
  if (!impl_->attenuating) return product;
  thread_local std::vector<Hit> crossed;
  crossings(ray, crossed);
  for (const Hit& hit : crossed) product *= impl_->callbacks.transmittance(hit, ray.direction);
  return product;
}

std::uint16_t RayScene::clear16(const ShadowPacket& packet) const {
  if (!impl_->attenuating) {
    unsigned valid = 0;
    for (unsigned k = 0; k < 16; ++k) valid |= unsigned{packet.valid[k] != 0} << k;
    return static_cast<std::uint16_t>(valid);
  }
  QueryContext context = context_for(*impl_);
  return unblocked16(impl_->attenuating->scene.get(), packet, context);
}

void RayScene::transmittance16(const ShadowPacket& packet, Rgb out[16]) const {
  std::fill_n(out, 16, Rgb(1));
  if (!impl_->attenuating) return;
  // Most segments meet no attenuating surface, and one packet tells which.
  const unsigned clear = clear16(packet);
  for (int k = 0; k < 16; ++k)
    if (packet.valid[k] && !(clear >> k & 1)) out[k] = transmittance(packet.ray(k));
}

}  // namespace lumirank::geometry
