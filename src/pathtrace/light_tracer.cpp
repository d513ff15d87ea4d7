#include "pathtrace/light_tracer.h"

#include <algorithm>
#include <cmath>

#include "scatter/closure.h"
#include "world/light_sampler.h"

namespace lumirank::pathtrace {
namespace {

using scatter::Closure;
using scatter::Lobes;

// From this depth on a path survives with the probability below at most.
constexpr int kDeepLightPath = 32;
constexpr float kDeepLightSurvival = 0.9f;

// Cosine of what arrives or leaves: with the surface itself, or across a fiber.
float crossing(const world::SurfaceHit& hit, const Closure& closure, Vec3f w) {
  return closure.is_fiber() ? closure.cosine(w) : std::abs(dot(hit.point.ng, w));
}

}  // namespace

float light_path_ratio(double light_paths, float eye, const world::SurfaceHit& hit, const Closure& closure,
                       Vec3f wo, Vec3f wi, float pdf) {
  const float from_eye = eye * crossing(hit, closure, wo) * pdf;
  return from_eye > 0 ? static_cast<float>(light_paths) * crossing(hit, closure, wi) / from_eye : 0.0f;
}

struct LightTracer::Flight {
  geometry::Ray ray;
  Rgb flux;
  float level;  // of flux: less is paid in the chance to survive
  std::uint64_t key;
  float density = 0;           // of the start, times the share found by the BSDF; 0: not known yet
  float traveled = 0;          // since the emitter, up to the first vertex
  int segments = 1;            // from the emitter, the current one included
  int non_delta_vertices = 0;  // passed
  bool after_specular = false;
  int medium = -1;  // that colors the glass which it is in; -1: none
};

int LightTracer::trace(SampleStream random, std::uint64_t key, std::vector<Splat>& splats) const {
  const auto start = starts_.sample(random);
  if (!start) return 0;
  Flight flight{start->ray, start->flux, max_component(start->flux), key};
  int rays = 0;
  constexpr int kMaxSteps = 4096;
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto hit = world_.intersect(flight.ray);
    ++rays;
    if (!hit) break;
    flight.flux *= world_.left_by_glass(flight.medium, hit->hit.t);
    if (is_black(flight.flux)) break;
    const Vec3f incoming = -flight.ray.direction;
    const Closure closure = world_.materials().closure(hit->material, hit->point, incoming);
    const bool first = flight.segments == 1;
    if (first) flight.traveled += hit->hit.t;
    const bool wanted = settings_.paths != Paths::rest || flight.after_specular;
    if (!first && wanted && closure.has_non_delta())
      rays += show(flight, *hit, random.next_2d(), splats) ? 1 : 0;
    const auto next =
        scatter::sample(closure, incoming, random.next_float(), random.next_2d(), Lobes::all, true);
    if (!next) break;
    flight.flux *= next->weight;
    if (!next->delta) flight.flux *= scatter::shading_correction(closure, incoming, next->wi);
    if (!next->delta || next->kind != scatter::LobeKind::delta_pass) {
      // One more segment follows, and the one to the eye.
      if (settings_.max_depth >= 0 && flight.segments + 2 > settings_.max_depth) break;
      if (first && !leave_first(*start, *hit, *next, flight)) break;
      ++flight.segments;
      flight.after_specular = next->delta;
      if (!next->delta) ++flight.non_delta_vertices;
    }
    float survival = std::min(1.0f, max_component(flight.flux) / flight.level);
    if (flight.segments > kDeepLightPath) survival = std::min(survival, kDeepLightSurvival);
    if (!(survival > 0) || (survival < 1 && random.next_float() >= survival)) break;
    flight.flux *= 1 / survival;
    if (!is_finite(flight.flux)) break;
    flight.medium = world_.medium_beyond(*hit, next->wi, flight.medium);
    flight.ray = {world::World::offset_origin(hit->point.position, hit->point.ng, next->wi), next->wi};
  }
  return rays;
}

// False: eye paths carry all that the path could show.
bool LightTracer::leave_first(const EmissionSampler::Start& start, const world::SurfaceHit& hit,
                              const scatter::BsdfSample& next, Flight& flight) const {
  const Vec3f wi = -flight.ray.direction, wo = next.wi;
  flight.density = starts_.density(start.emitter, start.triangle, flight.ray.origin, wi);
  // Nothing is sampled from a specular vertex: eye paths that come from there find it, or nobody does.
  if (next.delta) return flight.density > 0;
  const Closure closure = world_.materials().closure(hit.material, hit.point, wo);
  const float by_bsdf = scatter::pdf(closure, wo, wi, Lobes::all);
  if (!(by_bsdf > 0)) return false;
  const world::LightSampler& lights = world_.light_sampler();
  const auto at = world::lit_point(hit.point.position, closure, wo);
  if (start.delta) {
    const float choice = lights.probability_of_delta(at, start.emitter);
    flight.density = starts_.delta_density(start.emitter, hit.point.position, wi, flight.traveled) * by_bsdf;
    if (choice > 0) flight.density /= choice;
    return choice > 0 && flight.density > 0;
  }
  world::SurfaceHit emitting;
  emitting.emitter = start.emitter, emitting.hit.triangle = start.triangle;
  const float by_light = start.emitter == world_.environment()
                             ? lights.pdf_background(at, wi)
                             : lights.pdf_hit(at, emitting, wi, flight.traveled);
  flight.density *= by_bsdf / (by_bsdf + by_light);
  return flight.density > 0;
}

// Whether a ray went to the eye.
bool LightTracer::show(const Flight& flight, const world::SurfaceHit& hit, Vec2f lens,
                       std::vector<Splat>& splats) const {
  const auto seen = camera_.project(hit.point.position, lens);
  if (!seen || !window_.holds(seen->film)) return false;
  const Vec3f wo = seen->to_eye, wi = -flight.ray.direction;
  Closure closure = world_.materials().closure(hit.material, hit.point, wo);
  scatter::face_viewer(closure, wo);  // as eye paths do
  const float across = crossing(hit, closure, wi);
  if (!(across > 0)) return false;
  // Flux is measured through the surface, but eval() has the cosine of the shading normal.
  Rgb value = scatter::eval(closure, wo, wi) * flight.flux *
              (crossing(hit, closure, wo) * seen->density / (across * static_cast<float>(light_paths_)));
  if (is_black(value)) return false;
  const float pdf = scatter::pdf(closure, wo, wi, Lobes::all);
  const float ratio =
      flight.density * light_path_ratio(light_paths_, seen->density, hit, closure, wo, wi, pdf);
  value *= ratio / (1 + ratio);
  value *= world::visible_fraction(world_, hit.point.position, hit.point.ng, wo, seen->distance,
                                   mix64(flight.key + static_cast<std::uint64_t>(flight.segments)));
  if (is_black(value) || !is_finite(value)) return true;
  splats.push_back({seen->film, value, flight.non_delta_vertices == 0, ratio});
  return true;
}

}  // namespace lumirank::pathtrace
