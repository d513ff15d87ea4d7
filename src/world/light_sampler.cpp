#include "world/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "base/rgb.h"
#include "base/warp.h"
#include "emitters/area.h"

namespace lumirank::world {
namespace {

// The least part of all samples that near and far lights get where both shine: the power of an environment
// says little about what of it enters through a window.
constexpr float kGroupFloor = 0.25f;

using emitters::LightBound;

LightBound bound_of(const emitters::AreaEmitter::Triangle& t, float intensity) {
  LightBound b;
  for (const Vec3f corner : {t.p0, t.p0 + t.e1, t.p0 + t.e2}) b.bounds.extend(corner);
  b.axis = t.normal;
  b.intensity = intensity;
  return b;
}

// Seen from everywhere as its disc.
LightBound bound_of(const emitters::RoundLamp& lamp, float intensity) {
  LightBound b;
  const Vec3f extent{lamp.radius, lamp.radius, lamp.radius};
  b.bounds.extend(lamp.center - extent), b.bounds.extend(lamp.center + extent);
  b.spread = kPi;
  b.intensity = intensity / 4;
  return b;
}

LightBound bound_of(const emitters::PointEmitter& e) {
  LightBound b;
  b.bounds.extend(e.position);
  b.spread = kPi;
  b.intensity = luminance(e.intensity);
  return b;
}

// The fall-off is full up to some angle, then below a line that reaches zero at the cut-off; over a quarter
// turn or less the cosine lies above that line.
LightBound bound_of(const emitters::SpotEmitter& e) {
  LightBound b;
  b.bounds.extend(e.position);
  b.axis = e.frame.n;
  b.spread = std::max(e.beam, e.cutoff - kPi / 2);
  b.reach = e.cutoff - b.spread;
  b.intensity = luminance(e.intensity);
  return b;
}

// Full within the polar angles that are not dark, about whichever pole is nearer; nothing beyond.
LightBound bound_of(const emitters::ProfileEmitter& e) {
  LightBound b;
  b.bounds.extend(e.position);
  const float down = e.profile->max_theta(), up = kPi - e.profile->min_theta();
  b.axis = down <= up ? e.frame.n : -e.frame.n;
  b.spread = std::min(down, up);
  b.reach = std::min(0.01f, kPi - b.spread);
  b.intensity = luminance(e.scale) * e.profile->max_value();
  return b;
}

const emitters::EnvironmentEmitter* environment_of(const World& world) {
  if (world.environment() < 0) return nullptr;
  return std::get_if<emitters::EnvironmentEmitter>(
      &world.emitters()[static_cast<std::size_t>(world.environment())].kind);
}

}  // namespace

emitters::LitPoint lit_point(Vec3f position, const scatter::Closure& closure, Vec3f wo) {
  if (closure.is_fiber()) return {position, Vec3f{}, true};
  bool both_sides = false;
  for (int k = 0; k < closure.count; ++k) both_sides |= scatter::shines_through(closure.lobes[k].kind);
  const Vec3f n = closure.frame.n;
  return {position, dot(n, wo) < 0 ? -n : n, both_sides};
}

LightSampler::LightSampler(const World& world) : world_(world), round_(world.emitters().size()) {
  const auto& all = world.emitters();
  std::vector<LightBound> bounds;
  std::vector<float> far_weights;
  double near_power = 0, far_power = 0;
  const float radius = world.bounds().radius();
  for (std::size_t e = 0; e < all.size(); ++e) {
    first_leaf_.push_back(static_cast<std::uint32_t>(leaves_.size()));
    const int id = static_cast<int>(e);
    const float power = mean(emitters::power(all[e], radius));
    if (const auto* area = std::get_if<emitters::AreaEmitter>(&all[e].kind)) {
      const double total = area->by_power.total();
      round_[e] = emitters::round_lamp(*area);
      if (round_[e]) {
        leaves_.push_back({id, kRound});
        bounds.push_back(bound_of(*round_[e], static_cast<float>(total)));
      }
      for (std::size_t k = 0; !round_[e] && k < area->triangles.size(); ++k) {
        leaves_.push_back({id, static_cast<std::uint32_t>(k)});
        bounds.push_back(bound_of(area->triangles[k], static_cast<float>(area->by_power.pmf(k) * total)));
      }
      near_power += power;
    } else if (const auto* point = std::get_if<emitters::PointEmitter>(&all[e].kind)) {
      leaves_.push_back({id, 0}), bounds.push_back(bound_of(*point));
      near_power += power;
    } else if (const auto* spot = std::get_if<emitters::SpotEmitter>(&all[e].kind)) {
      leaves_.push_back({id, 0}), bounds.push_back(bound_of(*spot));
      near_power += power;
    } else if (const auto* profile = std::get_if<emitters::ProfileEmitter>(&all[e].kind)) {
      leaves_.push_back({id, 0}), bounds.push_back(bound_of(*profile));
      near_power += power;
    } else {
      const auto* map = std::get_if<emitters::EnvironmentEmitter>(&all[e].kind);
      if (map && map->width > 1) map_ = map;
      far_.push_back(id), far_weights.push_back(power);
      far_power += power;
    }
  }
  tree_ = emitters::LightTree(bounds);
  for (const LightBound& b : bounds)
    if (b.intensity > 0) place_bounds_.extend(b.bounds);
  far_choice_ = Distribution1D(far_weights);
  near_share_ = near_power > 0 ? static_cast<float>(near_power / (near_power + far_power)) : 0.0f;
  if (near_power > 0 && far_power > 0) near_share_ = std::clamp(near_share_, kGroupFloor, 1 - kGroupFloor);
}

// Where no near light can matter, all samples go to the far ones.
float LightSampler::near_share(const emitters::LitPoint& at) const {
  if (!(far_choice_.total() > 0)) return 1;
  return tree_.reaches(at) ? near_share_ : 0.0f;
}

const emitters::AreaEmitter* LightSampler::area_of(int emitter) const {
  return std::get_if<emitters::AreaEmitter>(&world_.emitters()[static_cast<std::size_t>(emitter)].kind);
}

const emitters::AreaEmitter* LightSampler::area_hit(const SurfaceHit& hit) const {
  const auto* area = hit.emitter < 0 ? nullptr : area_of(hit.emitter);
  // Triangle t of an area emitter is triangle t of its mesh.
  return area && hit.hit.triangle < area->triangles.size() ? area : nullptr;
}

std::uint32_t LightSampler::leaf_of(int emitter, std::uint32_t triangle) const {
  const auto e = static_cast<std::size_t>(emitter);
  return first_leaf_[e] + (round_[e] ? 0 : triangle);
}

LightSampler::Sample LightSampler::sample_leaf(std::uint32_t leaf, Vec3f at, Vec2f u) const {
  Sample s;
  const auto [emitter, triangle] = leaves_[leaf];
  s.emitter = emitter;
  const auto* area = area_of(emitter);
  if (!area) {
    s.direct = world_.sample_direct(emitter, at, 0, u);
  } else if (triangle != kRound) {
    s.direct = light_from(emitter, *area, {triangle, warp_triangle(u)}, at);
  } else if (const auto cone = round_[static_cast<std::size_t>(emitter)]->cone(at)) {
    s.direct = light_in(emitter, *cone, at, u);
  } else {
    const auto drawn = area->by_power.sample(u.x);
    s.direct = light_from(
        emitter, *area, {static_cast<std::uint32_t>(drawn.index), warp_triangle({drawn.remapped, u.y})}, at);
  }
  return s;
}

// What the direction first meets of the lamp, whatever stands before that, which is asked for afterwards. Not
// by way of the triangle: there are too many for the cache.
emitters::DirectSample LightSampler::light_in(int emitter, const emitters::RoundLamp::Cone& cone, Vec3f at,
                                              Vec2f u) const {
  constexpr int kMostSurfaces = 64;  // within the ball, but for the lamp; more than one is rare
  emitters::DirectSample s;
  s.direction = cone.sample(u);
  const Vec2f span = round_[static_cast<std::size_t>(emitter)]->span(at, s.direction);
  geometry::Ray ray{at, s.direction, span.x, span.y};
  for (int k = 0; k < kMostSurfaces && ray.t_min <= ray.t_max; ++k) {
    const auto hit = world_.rays().intersect(ray);
    if (!hit) break;
    if (world_.rays().placements()[hit->instance].emitter == static_cast<std::uint32_t>(emitter)) {
      s.distance = hit->t, s.triangle = hit->triangle, s.barycentric = hit->barycentric;
      s.pdf = cone.pdf();
      s.radiance = world_.emitted(emitter, s.triangle, s.barycentric);
      break;
    }
    ray.t_min = std::nextafter(hit->t, kInfinity);
  }
  return s;
}

emitters::DirectSample LightSampler::light_from(int emitter, const emitters::AreaEmitter& area,
                                                const OnLamp& place, Vec3f at) const {
  const auto& triangle = area.triangles[place.triangle];
  const Vec3f position = triangle.at(place.barycentric);
  emitters::DirectSample s;
  s.triangle = place.triangle, s.barycentric = place.barycentric;
  s.normal = triangle.normal;
  s.delta = !area.seen;
  s.distance = length(position - at);
  if (!(s.distance > 0)) return s;
  s.direction = (position - at) / s.distance;
  s.pdf = pdf_for(emitter, area, place.triangle, at, s.direction, s.distance);
  if (s.pdf > 0) s.radiance = world_.emitted(emitter, place.triangle, place.barycentric);
  return s;
}

float LightSampler::pdf_for(int emitter, const emitters::AreaEmitter& area, std::uint32_t triangle, Vec3f at,
                            Vec3f direction, float distance) const {
  const float pdf = emitters::pdf_direct_triangle(area.triangles[triangle], direction, distance);
  const auto& round = round_[static_cast<std::size_t>(emitter)];
  if (!round) return pdf;
  const auto cone = round->cone(at);
  if (!cone) return pdf * area.by_power.pmf(triangle);
  return pdf > 0 ? cone->pdf() : 0.0f;
}

float LightSampler::pdf_for_another(int emitter, const emitters::AreaEmitter& area, std::uint32_t triangle,
                                    Vec3f place, Vec3f drawn_for, Vec3f direction, float distance) const {
  const auto& t = area.triangles[triangle];
  const float pdf = emitters::pdf_direct_triangle(t, direction, distance);
  const auto& round = round_[static_cast<std::size_t>(emitter)];
  if (!round) return pdf;
  const auto cone = round->cone(drawn_for);
  if (!cone) return pdf * area.by_power.pmf(triangle);
  // By way of the density per area, which is that of directions from where it was drawn for.
  const Vec3f there = place - drawn_for;
  const float distance2 = length_squared(there), cosine = -dot(there, t.normal) / std::sqrt(distance2);
  return cosine > 0 ? pdf * t.area * cone->pdf() * cosine / distance2 : 0.0f;
}

LightSampler::Sample LightSampler::sample(const emitters::LitPoint& at, double u_light, Vec2f u) const {
  return sample(at, u_light, u, nullptr);
}

LightSampler::Sample LightSampler::sample_ahead(const emitters::LitPoint& at, double u_light,
                                                const Ahead& ahead) const {
  return sample(at, u_light, ahead.u, map_ ? &ahead : nullptr);
}

LightSampler::Sample LightSampler::sample(const emitters::LitPoint& at, double u_light, Vec2f u,
                                          const Ahead* ahead) const {
  Sample s;
  const float near = near_share(at);
  if (u_light < near) {
    const auto pick = tree_.sample(at, u_light / near);
    if (!(pick.pmf > 0)) return s;
    s = sample_leaf(pick.light, at.position, u);
    s.pdf = s.direct.pdf * near * pick.pmf;
  } else if (far_choice_.total() > 0) {
    const auto pick = far_choice_.sample(static_cast<float>((u_light - near) / (1.0 - near)));
    s.emitter = far_[pick.index];
    s.direct = ahead && s.emitter == world_.environment()
                   ? emitters::direct_of(map_->sample_in(ahead->texel))
                   : world_.sample_direct(s.emitter, at.position, 0, u);
    s.pdf = s.direct.pdf * (1 - near) * pick.pmf;
  }
  return s;
}

float LightSampler::pdf_hit(const emitters::LitPoint& at, const SurfaceHit& hit, Vec3f direction,
                            float distance) const {
  const auto* area = area_hit(hit);
  if (!area) return 0;
  const float pdf = pdf_for(hit.emitter, *area, hit.hit.triangle, at.position, direction, distance);
  return pdf > 0 ? pdf * near_share(at) * tree_.pmf(at, leaf_of(hit.emitter, hit.hit.triangle)) : 0.0f;
}

LightSampler::Place LightSampler::sample_place(const emitters::LitPoint& at, double u_light, Vec2f u) const {
  const auto pick = tree_.sample(at, u_light);
  if (!(pick.pmf > 0)) return {};
  const Leaf& leaf = leaves_[pick.light];
  Place place{.position = {}, .choice = pick.pmf, .leaf = pick.light, .triangle = 0, .barycentric = {}};
  if (const auto* area = area_of(leaf.emitter)) {
    // Also where it shines away from that point: it is to shine on others.
    const auto drawn = sample_leaf(pick.light, at.position, u).direct;
    if (!(drawn.distance > 0)) return {};
    place.triangle = drawn.triangle, place.barycentric = drawn.barycentric;
    place.position = area->triangles[place.triangle].at(place.barycentric);
    return place;
  }
  std::visit(
      [&](const auto& emitter) {
        if constexpr (requires { emitter.position; }) place.position = emitter.position;
      },
      world_.emitters()[static_cast<std::size_t>(leaf.emitter)].kind);
  return place;
}

LightSampler::Sample LightSampler::from_place(const emitters::LitPoint& at, const Place& place) const {
  Sample s;
  s.emitter = leaves_[place.leaf].emitter;
  if (const auto* area = area_of(s.emitter))
    s.direct = light_from(s.emitter, *area, {place.triangle, place.barycentric}, at.position);
  else
    s.direct = world_.sample_direct(s.emitter, at.position, 0, {});
  s.pdf = s.direct.pdf * near_share(at) * tree_.pmf(at, place.leaf);
  return s;
}

float LightSampler::pdf_place(const emitters::LitPoint& at, const Sample& found) const {
  const emitters::DirectSample& d = found.direct;
  if (!std::isfinite(d.distance)) return 0;
  float pdf = d.pdf;
  if (const auto* area = area_of(found.emitter)) {
    const Vec3f place = area->triangles[d.triangle].at(d.barycentric);
    pdf = pdf_for_another(found.emitter, *area, d.triangle, place, at.position, d.direction, d.distance);
  }
  return pdf * tree_.pmf(at, leaf_of(found.emitter, d.triangle));
}

float LightSampler::pdf_place(const emitters::LitPoint& at, const SurfaceHit& hit, Vec3f direction,
                              float distance) const {
  const auto* area = area_hit(hit);
  if (!area) return 0;
  const float pdf = pdf_for_another(hit.emitter, *area, hit.hit.triangle, hit.point.position, at.position,
                                    direction, distance);
  return pdf > 0 ? pdf * tree_.pmf(at, leaf_of(hit.emitter, hit.hit.triangle)) : 0.0f;
}

float LightSampler::choice_of_environment(const emitters::LitPoint& at) const {
  const auto k =
      static_cast<std::size_t>(std::find(far_.begin(), far_.end(), world_.environment()) - far_.begin());
  return (1 - near_share(at)) * far_choice_.pmf(k);
}

float LightSampler::pdf_background(const emitters::LitPoint& at, Vec3f direction) const {
  const auto* environment = environment_of(world_);
  return environment ? choice_of_environment(at) * environment->pdf(direction) : 0.0f;
}

emitters::EnvironmentEmitter::Seen LightSampler::background(const emitters::LitPoint& at,
                                                            Vec3f direction) const {
  const auto* environment = environment_of(world_);
  if (!environment) return {};
  emitters::EnvironmentEmitter::Seen seen = environment->look(direction);
  seen.pdf *= choice_of_environment(at);
  return seen;
}

emitters::EnvironmentEmitter::Seen LightSampler::background_at(const emitters::LitPoint& at,
                                                               Vec2f position) const {
  return {map_->eval_at(position), choice_of_environment(at) * map_->pdf_at(position)};
}

float LightSampler::probability_of_delta(const emitters::LitPoint& at, int emitter) const {
  const auto far = std::find(far_.begin(), far_.end(), emitter);
  if (far == far_.end())
    return near_share(at) * tree_.pmf(at, first_leaf_[static_cast<std::size_t>(emitter)]);
  return (1 - near_share(at)) * far_choice_.pmf(static_cast<std::size_t>(far - far_.begin()));
}

Rgb visible_fraction(const World& world, Vec3f from, Vec3f ng, Vec3f direction, float distance,
                     std::uint64_t key) {
  const Vec3f origin = World::offset_origin(from, ng, direction);
  geometry::Ray ray{origin, direction, 0, kInfinity};
  if (std::isfinite(distance)) {
    // Aimed anew from the moved origin, which may be farther off the surface than the open end is long; the
    // lamp itself must not block.
    ray.direction = from + direction * distance - origin;
    ray.t_max = 1 - 1e-4f;
  }
  if (world.rays().occluded(ray, key)) return Rgb{0};
  return world.rays().has_attenuating() ? world.rays().transmittance(ray) : Rgb{1};
}

}  // namespace lumirank::world
