#include "world/world.h"

#include <cmath>
#include <utility>

#include "world/impl.h"
#include "world/surface.h"

namespace lumirank::world {

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(World&&) noexcept = default;
World::~World() = default;

const geometry::RayScene& World::rays() const { return *impl_->rays; }
const scatter::MaterialSet& World::materials() const { return impl_->materials; }
const std::vector<emitters::Emitter>& World::emitters() const { return impl_->emitters; }
const std::vector<media::Medium>& World::media() const { return impl_->media; }
Rgb World::left_by_glass(int medium, float length) const {
  if (medium < 0 || impl_->absorption.empty()) return Rgb(1);
  Rgb left = impl_->absorption[static_cast<std::size_t>(medium)];
  for (int c = 0; c < 3; ++c) left[c] = std::exp(-left[c] * length);
  return left;
}
bool World::divides_media(std::uint32_t placement) const {
  return impl_->placements[placement].media.divides;
}
int World::medium_beyond(const SurfaceHit& hit, Vec3f direction, int current) const {
  const scenedesc::MediumInterfaceDesc& media = impl_->placements[hit.hit.instance].media;
  if (!media.divides) return current;
  return dot(direction, hit.point.ng) < 0 ? media.inside : media.outside;
}
int World::environment() const { return impl_->environment; }
const LightSampler& World::light_sampler() const {
  std::call_once(impl_->sampler_made, [this] { impl_->sampler = std::make_unique<LightSampler>(*this); });
  return *impl_->sampler;
}
const Bounds3f& World::bounds() const { return impl_->bounds; }
const std::vector<std::uint64_t>& World::placement_ids() const { return impl_->placement_ids; }
const Units& World::units() const { return impl_->units; }
const WorldInfo& World::info() const { return impl_->info; }

std::optional<SurfaceHit> World::intersect(const geometry::Ray& ray) const {
  const std::optional<geometry::Hit> hit = impl_->rays->intersect(ray);
  if (!hit) return std::nullopt;
  return impl_->surface(*hit, ray.direction);
}

std::optional<SurfaceHit> World::intersect_from_eye(geometry::Ray ray) const {
  auto hit = intersect(ray);
  if (!impl_->hides_emitters) return hit;
  constexpr int kMaxSurfaces = 1024;
  const Vec3f eye = ray.origin;
  for (int k = 0; k < kMaxSurfaces && hit && hit->emitter >= 0; ++k) {
    ray.t_max -= hit->hit.t, ray.t_min = 0;
    ray.origin = offset_origin(hit->point.position, hit->point.ng, ray.direction);
    hit = intersect(ray);
  }
  if (hit) hit->hit.t = length(hit->point.position - eye) / length(ray.direction);
  return hit;
}

bool World::hides_emitters() const { return impl_->hides_emitters; }

SurfaceHit World::surface(const geometry::Hit& hit, Vec3f ray_direction) const {
  return impl_->surface(hit, ray_direction);
}

Rgb World::emitted(const SurfaceHit& at, Vec3f wo) const {
  if (at.emitter < 0 || !(dot(wo, at.point.ng) > 0)) return Rgb{};
  return impl_->emitted_at(at.emitter, at.hit.triangle, at.hit.barycentric);
}

Rgb World::emitted(int emitter, std::uint32_t triangle, Vec2f barycentric) const {
  return impl_->emitted_at(emitter, triangle, barycentric);
}

Rgb World::background(Vec3f direction) const {
  if (impl_->environment < 0) return Rgb{};
  const auto& kind = impl_->emitters[static_cast<std::size_t>(impl_->environment)].kind;
  return std::get<emitters::EnvironmentEmitter>(kind).eval(direction);
}

Rgb World::sun_disc(Vec3f direction) const {
  Rgb sum;
  for (const std::size_t k : impl_->suns)
    sum += std::get<emitters::DirectionalEmitter>(impl_->emitters[k].kind).radiance_from(direction);
  return sum;
}

emitters::DirectSample World::sample_direct(int emitter, Vec3f point, float u1, Vec2f u2) const {
  const auto& e = impl_->emitters[static_cast<std::size_t>(emitter)];
  emitters::DirectSample s = emitters::sample_direct(e, point, u1, u2);
  if (s.pdf > 0 && std::holds_alternative<emitters::AreaEmitter>(e.kind))
    s.radiance = impl_->emitted_at(emitter, s.triangle, s.barycentric);
  return s;
}

emitters::Emission World::sample_emission(int emitter, float u1, Vec2f u_position, Vec2f u_direction) const {
  const auto& e = impl_->emitters[static_cast<std::size_t>(emitter)];
  emitters::Emission s = emitters::sample_emission(e, impl_->bounds, u1, u_position, u_direction);
  const auto* area = std::get_if<emitters::AreaEmitter>(&e.kind);
  if (area && impl_->radiance[static_cast<std::size_t>(emitter)].texture >= 0 && !(s.normal == Vec3f{})) {
    const auto& t = area->triangles[s.triangle];
    const float pdf = area->by_power.pmf(s.triangle) / t.area;
    s.weight = impl_->emitted_at(emitter, s.triangle, s.barycentric) * (kPi / pdf);
  }
  return s;
}

Vec3f World::offset_origin(Vec3f p, Vec3f ng, Vec3f direction) {
  // Positions and intersection distances are rounded in proportion to the coordinates they are computed from
  // (2⁻²⁴ of them, several times over), so the step is 5·10⁻⁵ of the point's largest coordinate: a few
  // hundred roundings. Near the origin of the world, where the triangles' corners are larger than the point,
  // the step stays at that of a coordinate of 0.02.
  const float size = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), 0.02f});
  const float step = 5e-5f * size;
  if (ng == Vec3f{}) return p + direction * (step / length(direction));
  return p + ng * (dot(direction, ng) < 0 ? -step : step);
}

}  // namespace lumirank::world
