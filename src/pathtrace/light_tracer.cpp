#include "pathtrace/light_tracer.h"

#include <algorithm>
#include <cmath>

#include "media/forced_collision.h"
#include "pathtrace/light_path_balance.h"
#include "scatter/closure.h"
#include "world/light_sampler.h"
#include "world/straight_path.h"

namespace lumirank::pathtrace {
namespace {

using scatter::Closure;
using scatter::Lobes;

// From this depth on a path survives with the probability below at most.
constexpr int kDeepLightPath = 32;
constexpr float kDeepLightSurvival = 0.9f;

}  // namespace

struct LightTracer::Flight {
  SampleStream random;
  std::uint64_t key;
  geometry::Ray ray;
  media::ChannelThroughput carried;  // its weight is the flux
  float level;                       // of flux: less is paid in the chance to survive
  int hero = 0;                      // the channel that distances are drawn for
  int medium = -1;                   // that the path is in, or that colors the glass which it is in; -1: none
  float density = 0;                 // of the start, times the share found by the BSDF; 0: not known yet
  float traveled = 0;                // since the emitter, up to the first vertex
  int segments = 1;                  // from the emitter, the current one included
  int non_delta_vertices = 0;        // passed
  bool after_specular = false;

  bool first() const { return segments == 1; }
};

LightTracer::LightTracer(const world::World& world, const world::Camera& camera,
                         const EmissionSampler& starts, const Window& window, const PathSettings& settings,
                         double light_paths, int eye_medium)
    : world_(world),
      camera_(camera),
      starts_(starts),
      window_(window),
      settings_(settings),
      light_paths_(light_paths),
      emitter_media_(world, camera.eye(), eye_medium) {}

int LightTracer::trace(SampleStream random, std::uint64_t key, const MergePoints& points,
                       Found& found) const {
  const auto start = starts_.sample(random);
  if (!start) return 0;
  Flight flight{random, key, start->ray, {start->flux, Rgb(1)}, max_component(start->flux)};
  if (!world_.media().empty()) begin_in_medium(*start, flight);
  int rays = 0;
  constexpr int kMaxSteps = 4096;
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto hit = world_.intersect(flight.ray);
    ++rays;
    if (flight.medium >= 0 && !world_.media().empty()) {
      const float distance = hit ? hit->hit.t : kInfinity;
      rays += show_along(flight, distance, found) ? 1 : 0;
      const Way way = fly(flight, distance);
      if (way == Way::ended) break;
      if (way == Way::scattered) {
        if (!scatter_in_medium(*start, flight) || !survives(flight)) break;
        continue;
      }
    }
    if (!hit) break;
    flight.carried.multiply(world_.left_by_glass(flight.medium, hit->hit.t));
    if (is_black(flight.carried.throughput)) break;
    const Vec3f incoming = -flight.ray.direction;
    const Closure closure = world_.materials().closure(hit->material, hit->point, incoming);
    if (flight.first()) flight.traveled += hit->hit.t;
    const bool wanted = settings_.paths != Paths::rest || flight.after_specular;
    if (!flight.first() && wanted && closure.has_non_delta()) {
      rays += show(flight, *hit, found) ? 1 : 0;
      merge(flight, *hit, points, found);
    }
    const Vec2f u = flight.random.next_2d();
    const auto next = scatter::sample(closure, incoming, flight.random.next_float(), u, Lobes::all, true);
    if (!next) break;
    flight.carried.multiply(next->weight);
    if (!next->delta) flight.carried.multiply(Rgb(scatter::shading_correction(closure, incoming, next->wi)));
    if (!next->delta || next->kind != scatter::LobeKind::delta_pass) {
      if (!may_turn(flight)) break;
      if (flight.first() && !leave_first(*start, *hit, *next, flight)) break;
      ++flight.segments;
      flight.after_specular = next->delta;
      if (!next->delta) ++flight.non_delta_vertices;
    }
    if (!survives(flight)) break;
    flight.medium = world_.medium_beyond(*hit, next->wi, flight.medium);
    flight.ray = {world::World::offset_origin(hit->point.position, hit->point.ng, next->wi), next->wi};
  }
  return rays;
}

// Light from far away has come through what is there.
void LightTracer::begin_in_medium(const EmissionSampler::Start& start, Flight& flight) const {
  flight.hero = std::min(2, static_cast<int>(3 * flight.random.next_float()));
  flight.medium = emitter_media_.of(start.emitter, flight.ray);
  if (flight.medium < 0 || !start.far) return;
  flight.carried.multiply(media::transmittance(world_.media()[static_cast<std::size_t>(flight.medium)],
                                               flight.ray.origin, -flight.ray.direction, kInfinity,
                                               [&flight] { return flight.random.next_float(); }));
}

// One more segment follows, and the one to the eye.
bool LightTracer::may_turn(const Flight& flight) const {
  return settings_.max_depth < 0 || flight.segments + 2 <= settings_.max_depth;
}

// Russian roulette; false ends the path.
bool LightTracer::survives(Flight& flight) const {
  float survival = std::min(1.0f, max_component(flight.carried.weight()) / flight.level);
  if (flight.segments > kDeepLightPath) survival = std::min(survival, kDeepLightSurvival);
  if (!(survival > 0) || (survival < 1 && flight.random.next_float() >= survival)) return false;
  flight.carried.multiply(Rgb(1 / survival));
  return is_finite(flight.carried.throughput);
}

// The way to the next surface, through a medium: arrived there, or collided, where flight.ray then begins.
LightTracer::Way LightTracer::fly(Flight& flight, float distance) const {
  const media::Medium& medium = world_.media()[static_cast<std::size_t>(flight.medium)];
  const auto random = [&flight] { return flight.random.next_float(); };
  if (!medium.scatters()) {
    flight.carried.multiply(
        media::transmittance(medium, flight.ray.origin, flight.ray.direction, distance, random));
    return is_black(flight.carried.throughput) ? Way::ended : Way::arrived;
  }
  bool scattered = false;
  const bool arrived =
      media::fly(medium, flight.ray.origin, flight.ray.direction, distance, flight.hero, random,
                 flight.carried, [&](float t, const media::Coefficients& at, Rgb bound) {
                   const Rgb null = bound - at.extinction;
                   if (random() * bound[flight.hero] >= at.extinction[flight.hero]) {
                     if (null[flight.hero] > 0) flight.carried.event(null, null, flight.hero);
                     return true;
                   }
                   flight.carried.event(at.scattering, at.extinction, flight.hero);
                   if (flight.first()) flight.traveled += t;
                   flight.ray.origin += flight.ray.direction * t;
                   scattered = !is_black(at.scattering);
                   return false;
                 });
  return arrived ? Way::arrived : (scattered ? Way::scattered : Way::ended);
}

// At the place where the flight has collided; false ends the path.
bool LightTracer::scatter_in_medium(const EmissionSampler::Start& start, Flight& flight) const {
  if (!may_turn(flight)) return false;
  const media::PhaseFunction& phase = world_.media()[static_cast<std::size_t>(flight.medium)].phase();
  const Vec3f forward = flight.ray.direction;
  const Vec2f u = flight.random.next_2d();
  const Vec3f next = phase.sample(forward, flight.hero, flight.random.next_float(), u);
  const Rgb f = phase.eval(dot(forward, next));
  if (!(f[flight.hero] > 0)) return false;
  flight.carried.event(f, f, flight.hero);
  if (flight.first() && !leave_first(start, {flight.ray.origin, Vec3f{}, true}, -forward, mean(f), flight))
    return false;
  ++flight.segments, ++flight.non_delta_vertices;
  flight.after_specular = false;
  flight.ray = {flight.ray.origin, next};
  return true;
}

// From the vertex next to the emitter. False: eye paths carry all that the path could show.
bool LightTracer::leave_first(const EmissionSampler::Start& start, const world::SurfaceHit& hit,
                              const scatter::BsdfSample& next, Flight& flight) const {
  const Vec3f wi = -flight.ray.direction, wo = next.wi;
  if (next.delta) {
    // Nothing is sampled from a specular vertex: eye paths that come from there find it, or nobody does.
    flight.density = starts_.density(start.emitter, start.triangle, flight.ray.origin, wi);
    return flight.density > 0;
  }
  const Closure closure = world_.materials().closure(hit.material, hit.point, wo);
  return leave_first(start, world::lit_point(hit.point.position, closure, wo), wi,
                     scatter::pdf(closure, wo, wi, Lobes::all), flight);
}

// `turned`: density with which an eye path takes wi there.
bool LightTracer::leave_first(const EmissionSampler::Start& start, const emitters::LitPoint& at, Vec3f wi,
                              float turned, Flight& flight) const {
  if (!(turned > 0)) return false;
  const world::LightSampler& lights = world_.light_sampler();
  if (start.delta) {
    const float choice = lights.probability_of_delta(at, start.emitter);
    flight.density = starts_.delta_density(start.emitter, at.position, wi, flight.traveled) * turned;
    if (choice > 0) flight.density /= choice;
    return choice > 0 && flight.density > 0;
  }
  world::SurfaceHit emitting;
  emitting.emitter = start.emitter, emitting.hit.triangle = start.triangle;
  const float by_light = start.emitter == world_.environment()
                             ? lights.pdf_background(at, wi)
                             : lights.pdf_hit(at, emitting, wi, flight.traveled);
  flight.density = starts_.density(start.emitter, start.triangle, flight.ray.origin, wi);
  flight.density *= turned / (turned + by_light);
  return flight.density > 0;
}

// Whether a ray went to the eye.
bool LightTracer::show(Flight& flight, const world::SurfaceHit& hit, Found& found) const {
  const auto seen = camera_.project(hit.point.position, flight.random.next_2d());
  if (!seen || !window_.holds(seen->film)) return false;
  const Vec3f wo = seen->to_eye, wi = -flight.ray.direction;
  Closure closure = world_.materials().closure(hit.material, hit.point, wo);
  scatter::face_viewer(closure, wo);  // as eye paths do
  const float across = crossing(hit, closure, wi);
  if (!(across > 0)) return false;
  // Flux is measured through the surface, but eval() has the cosine of the shading normal.
  Rgb value = scatter::eval(closure, wo, wi) * flight.carried.weight() *
              (crossing(hit, closure, wo) * seen->density / (across * static_cast<float>(light_paths_)));
  if (is_black(value)) return false;
  const float pdf = scatter::pdf(closure, wo, wi, Lobes::all);
  const float ratio =
      flight.density * light_path_ratio(light_paths_, seen->density, hit, closure, wo, wi, pdf);
  value *= ratio / (1 + ratio);
  if (behind_glass(hit.point.position, *seen, found)) return true;
  value *= world_.media().empty()
               ? world::visible_fraction(world_, hit.point.position, hit.point.ng, wo, seen->distance,
                                         mix64(flight.key + static_cast<std::uint64_t>(flight.segments)))
               : world::pass_straight(world_,
                                      {hit.point.position, hit.point.ng, wo, seen->distance,
                                       world_.medium_beyond(hit, wo, flight.medium)},
                                      [&flight] { return flight.random.next_float(); });
  if (is_black(value) || !is_finite(value)) return true;
  found.splats.push_back({seen->film, value, flight.non_delta_vertices == 0, ratio});
  return true;
}

// Whether the eye sees the place by glass alone, for which eye paths are merged: panes that let light pass
// straight do not show it to the eye (path_tracer.cpp).
bool LightTracer::behind_glass(Vec3f place, const world::Camera::Seen& seen, Found& found) const {
  if (world_.info().panes == 0) return false;
  const float open = geometry::kShadowEpsilon;
  world_.rays().crossings({place, seen.to_eye, open * seen.distance, (1 - open) * seen.distance},
                          found.crossed);
  return std::ranges::any_of(found.crossed, [&](const geometry::Hit& hit) {
    const auto material = static_cast<int>(world_.rays().placements()[hit.instance].material);
    return world_.materials().seen(material) != material;
  });
}

// With one of the eye paths that it is near to, for all of them: where one light path adds to several pixels
// noise has a grain that a denoiser keeps.
void LightTracer::merge(Flight& flight, const world::SurfaceHit& hit, const MergePoints& points,
                        Found& found) const {
  points.around(hit.point, found.near);
  if (found.near.empty()) return;
  const auto number = static_cast<float>(found.near.size());
  const auto drawn = static_cast<std::size_t>(number * flight.random.next_float());
  const MergePoint& point = *found.near[std::min(drawn, found.near.size() - 1)];
  if (settings_.max_depth >= 0 && point.segments + flight.segments > settings_.max_depth) return;
  const Vec3f wi = -flight.ray.direction;
  Closure closure = world_.materials().closure(point.hit.material, point.hit.point, point.wo);
  scatter::face_viewer(closure, point.wo);
  const float across = crossing(point.hit, closure, wi);
  const float pdf = scatter::pdf(closure, point.wo, wi, Lobes::all);
  if (!(across > 0) || !(pdf > 0)) return;
  const float ratio =
      flight.density * merged_light_path_ratio(light_paths_, point.area, point.hit, closure, wi, pdf);
  const Rgb value = point.throughput * scatter::eval(closure, point.wo, wi) * flight.carried.weight() *
                    (number * ratio / (1 + ratio) / (across * point.area * static_cast<float>(light_paths_)));
  if (is_black(value) || !is_finite(value)) return;
  found.merged.push_back({point.pixel, value, flight.non_delta_vertices == 0, ratio});
}

// The same of a place on the way through a medium.
bool LightTracer::show_along(Flight& flight, float distance, Found& found) const {
  const media::Medium& medium = world_.media()[static_cast<std::size_t>(flight.medium)];
  if (flight.first() || !medium.scatters()) return false;
  const auto random = [&flight] { return flight.random.next_float(); };
  const Vec3f origin = flight.ray.origin, forward = flight.ray.direction;
  const float u_channel = random();
  const RayPlace forced = media::force_collision(medium, origin, forward, distance, u_channel, random());
  if (!(forced.pdf > 0)) return false;
  const Vec3f place = origin + forward * forced.t;
  const auto seen = camera_.project(place, flight.random.next_2d());
  if (!seen || !window_.holds(seen->film)) return false;
  const Rgb f = medium.phase().eval(dot(forward, seen->to_eye));
  Rgb value = flight.carried.weight() * medium.at(place).scattering * f *
              (seen->density / (forced.pdf * static_cast<float>(light_paths_)));
  if (is_black(value)) return false;
  const float ratio = flight.density * light_path_ratio(light_paths_, seen->density, mean(f));
  value *= ratio / (1 + ratio);
  if (behind_glass(place, *seen, found)) return true;
  value *= media::transmittance(medium, origin, forward, forced.t, random);
  value *=
      world::pass_straight(world_, {place, Vec3f{}, seen->to_eye, seen->distance, flight.medium}, random);
  if (is_black(value) || !is_finite(value)) return true;
  found.splats.push_back({seen->film, value, flight.non_delta_vertices == 0, ratio});
  return true;
}

}  // namespace lumirank::pathtrace
