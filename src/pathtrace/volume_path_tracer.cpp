#include "pathtrace/volume_path_tracer.h"

#include <algorithm>
#include <cmath>

#include "pathtrace/found_emission.h"
#include "pathtrace/lit_stretch.h"
#include "scatter/closure.h"

namespace lumirank::pathtrace {

using scatter::Closure;
using scatter::LobeKind;
using scatter::Lobes;

// The last vertex that scattered, and what weighs the ways to the light seen from there against each other:
// light sampling, the direction taken, and, of collisions in a medium, light sampling along the flight that
// led there. Balance heuristic over the three, each by the mean of its densities over the channels.
struct VolumePathTracer::Vertex {
  emitters::LitPoint at{};
  Rgb reached{1};       // relative densities of the channels for getting here
  Rgb direction{0};     // of the direction taken
  Rgb started{0};       // as `reached`, at the start of the flight
  LitStretch flight{};  // empty: nothing was sampled along it
  float t = 0;          // where on it this is

  float along(Vec3f lamp, float place_pdf) const {
    return place_pdf > 0 ? place_pdf * flight.pdf(lamp, t) : 0.0f;
  }
  // Of everything that could have found light by light sampling with density `light`, by direction with
  // `turned`, and along the flight with `along`.
  float all(float light, Rgb turned, float along) const {
    return mean(reached * (turned + Rgb(light)) + started * along);
  }
};

// The state of a path between two vertices.
struct VolumePathTracer::Walk {
  SampleStream random;
  geometry::Ray ray;  // of unit direction
  int hero;           // the channel that distances are drawn for
  int medium;         // that the path is in, -1: none
  media::ChannelThroughput path;
  int segments = 1;            // so far, the current one included; straight passes do not count
  int non_delta_vertices = 0;  // passed
  bool specular = true;        // the last vertex was specular (or the eye)
  Vertex vertex{};             // the last non-delta one
  float traveled = 0;          // since then
  float eta_scale = 1;         // undoes refraction's scaling for Russian roulette
  bool from_eye = false;       // light paths may show the vertex that comes next
  float light_paths = 0;       // LightPathBalance's ratio of the first vertex that is not specular; 0: none
  geometry::Ray eye_ray{};
  float from_camera = 0;  // way from the camera to the last vertex
  std::vector<MergePoint>* merge_points = nullptr;
  Radiance sum{};

  void add(Rgb value) {
    Rgb& part =
        non_delta_vertices == 0 ? sum.emission : (non_delta_vertices == 1 ? sum.direct : sum.indirect);
    part += value;
  }
};

VolumePathTracer::VolumePathTracer(const world::World& world, std::uint64_t seed, int max_depth,
                                   int eye_medium)
    : world_(world),
      lights_(world.light_sampler()),
      seed_(seed),
      max_depth_(max_depth),
      eye_medium_(eye_medium) {}

Radiance VolumePathTracer::trace(geometry::Ray ray, std::uint32_t place, std::uint64_t sample,
                                 std::vector<MergePoint>* merge_points) const {
  Walk walk{.random = SampleStream::over_film(seed_, Stage::reference, 0, place, sample),
            .ray = ray,
            .hero = 0,
            .medium = eye_medium_,
            .path = {},
            .from_eye = beside_.has_value(),
            .eye_ray = ray,
            .merge_points = merge_points};
  walk.ray.direction = walk.eye_ray.direction = normalize(ray.direction);
  const float longer = length(ray.direction);
  walk.ray.t_min *= longer, walk.ray.t_max *= longer;
  walk.hero = std::min(2, static_cast<int>(3 * walk.random.next_float()));
  for (int step = 0; step < world::kMaxPasses; ++step) {
    const bool seen = walk.segments == 1;  // by nothing but the eye
    const auto hit = seen ? world_.intersect_from_eye(walk.ray) : world_.intersect(walk.ray);
    const float distance = hit ? hit->hit.t : kInfinity;
    const Flight flight = fly(walk, distance);
    if (flight == Flight::ended) break;
    if (flight == Flight::scattered) continue;
    if (hit) walk.traveled += distance;
    if (!hit && seen && world_.hides_emitters()) break;
    add_emission(walk, hit ? &*hit : nullptr);
    if (!hit || !scatter_on_surface(walk, *hit)) break;
  }
  walk.sum.segments = walk.segments;
  return walk.sum;
}

// The way to the next surface: arrived there, or scattered before it (and the ray is a new one).
VolumePathTracer::Flight VolumePathTracer::fly(Walk& walk, float distance) const {
  if (walk.medium < 0) return Flight::arrived;
  const media::Medium& medium = world_.media()[static_cast<std::size_t>(walk.medium)];
  if (!medium.scatters() && !medium.emits()) {
    // Colored glass: what comes through is known, and a path that collided would only end.
    walk.path.multiply(media::transmittance(medium, walk.ray.origin, walk.ray.direction, distance,
                                            [&walk] { return walk.random.next_float(); }));
    return is_black(walk.path.throughput) ? Flight::ended : Flight::arrived;
  }
  LitStretch lit;
  if (lights_.place_share() > 0 && medium.scatters() && (max_depth_ < 0 || walk.segments < max_depth_)) {
    // What the eye sees of a medium is seen by itself; later flights are worth what lamps are among lights.
    const float share = walk.non_delta_vertices == 0 ? 1.0f : lights_.place_share();
    lit = LitStretch(medium, walk.ray.origin, walk.ray.direction, distance, share, walk.random.next_float());
    if (!lit.near(lights_.place_bounds())) lit = {};
    if (!lit.empty() && (share >= 1 || walk.random.next_float() < share))
      sample_lamp_along(walk, medium, lit);
  }
  const Rgb started = walk.path.likelihood;
  bool scattered = false;
  const auto random = [&walk] { return walk.random.next_float(); };
  const bool arrived =
      media::fly(medium, walk.ray.origin, walk.ray.direction, distance, walk.hero, random, walk.path,
                 [&](float t, const media::Coefficients& at, Rgb bound) {
                   if (medium.emits()) {
                     media::ChannelThroughput shining = walk.path;
                     shining.event(at.emission, bound, walk.hero);
                     walk.add(shining.weight());
                   }
                   const Rgb null = bound - at.extinction;
                   if (walk.random.next_float() * bound[walk.hero] >= at.extinction[walk.hero]) {
                     if (!(null[walk.hero] > 0)) return true;  // by rounding alone
                     walk.path.event(null, null, walk.hero);
                     return true;
                   }
                   walk.path.event(at.scattering, at.extinction, walk.hero);
                   walk.traveled += t;
                   walk.vertex = {.at = {walk.ray.origin + walk.ray.direction * t, Vec3f{}, true},
                                  .reached = walk.path.likelihood};
                   if (lit.covers(t)) {
                     const Rgb reached = started * lit.collision_density(t, at.extinction);
                     if (mean(reached) > 0)
                       walk.vertex.reached = reached, walk.vertex.started = started, walk.vertex.flight = lit,
                       walk.vertex.t = t;
                   }
                   scattered = scatter_in_medium(walk, at);
                   return false;
                 });
  if (arrived) return Flight::arrived;
  return scattered ? Flight::scattered : Flight::ended;
}

// Direct light of a lamp at a place of the flight that is drawn for the lamp.
void VolumePathTracer::sample_lamp_along(Walk& walk, const media::Medium& medium,
                                         const LitStretch& lit) const {
  const auto [u_light, u_place] = walk.random.next_fine();
  const auto lamp = lights_.sample_place(lit.chosen_for(), u_light, walk.random.next_2d());
  if (!(lamp.choice > 0)) return;
  const RayPlace on_flight = lit.sample(lamp.position, u_place);
  if (!(on_flight.pdf > 0)) return;
  const Vec3f place = walk.ray.origin + walk.ray.direction * on_flight.t;
  const media::Coefficients at = medium.at(place);
  if (is_black(at.scattering)) return;
  const Rgb reached = walk.path.likelihood * lit.collision_density(on_flight.t, at.extinction);
  if (!(mean(reached) > 0)) return;
  const auto light = lights_.from_place({place, Vec3f{}, true}, lamp);
  if (!(light.direct.pdf > 0) || is_black(light.direct.radiance)) return;
  const Rgb f = medium.phase().eval(dot(walk.ray.direction, light.direct.direction));
  const Vertex vertex{.at = {}, .reached = reached, .started = walk.path.likelihood};
  const float all =
      vertex.all(light.pdf, light.direct.delta ? Rgb{0} : f, lamp.choice * light.direct.pdf * on_flight.pdf);
  const auto random = [&walk] { return walk.random.next_float(); };
  const Rgb before = media::transmittance(medium, walk.ray.origin, walk.ray.direction, on_flight.t, random);
  const Rgb visible = world::pass_straight(
      world_, {place, Vec3f{}, light.direct.direction, light.direct.distance, walk.medium}, random);
  ++walk.non_delta_vertices;
  walk.add(walk.path.throughput * before * at.scattering * f * light.direct.radiance * visible *
           (left_of_sampled(walk, place, light, mean(f)) / all));
  --walk.non_delta_vertices;
}

// At walk.vertex.
bool VolumePathTracer::scatter_in_medium(Walk& walk, const media::Coefficients& at) const {
  if (is_black(at.scattering)) return false;
  if (max_depth_ >= 0 && walk.segments >= max_depth_) return false;
  const media::PhaseFunction& phase = world_.media()[static_cast<std::size_t>(walk.medium)].phase();
  const Vec3f forward = walk.ray.direction;
  Vertex& vertex = walk.vertex;
  const Vec3f place = vertex.at.position;
  ++walk.non_delta_vertices;

  const auto [u_light, u_lobe] = walk.random.next_fine();
  const auto light = lights_.sample(vertex.at, u_light, walk.random.next_2d());
  if (light.pdf > 0) {
    const Rgb f = phase.eval(dot(forward, light.direct.direction));
    const auto random = [&walk] { return walk.random.next_float(); };
    const Rgb visible = world::pass_straight(
        world_, {place, Vec3f{}, light.direct.direction, light.direct.distance, walk.medium}, random);
    const float along = vertex.flight.empty()
                            ? 0.0f
                            : vertex.along(place + light.direct.direction * light.direct.distance,
                                           lights_.pdf_place(vertex.flight.chosen_for(), light));
    const float all = vertex.all(light.pdf, light.direct.delta ? Rgb{0} : f, along);
    walk.add(walk.path.weight() * f * light.direct.radiance * visible *
             (left_of_sampled(walk, place, light, mean(f)) * mean(vertex.reached) / all));
  }

  const Vec3f next = phase.sample(forward, walk.hero, u_lobe, walk.random.next_2d());
  const Rgb f = phase.eval(dot(forward, next));
  if (!(f[walk.hero] > 0)) return false;
  walk.path.event(f, f, walk.hero);
  if (walk.from_eye) walk.light_paths = beside_->ratio_within(walk.ray, walk.traveled, mean(f));
  walk.from_eye = false;
  vertex.direction = f;
  walk.specular = false;
  walk.traveled = 0;
  ++walk.segments;
  walk.ray = {place, next};
  return survives(walk);
}

// What shines at the end of the current segment, weighted against light sampling.
void VolumePathTracer::add_emission(Walk& walk, const world::SurfaceHit* hit) const {
  const Vertex& vertex = walk.vertex;
  const FoundEmission found = found_emission(world_, lights_, walk.specular ? nullptr : &vertex.at, hit,
                                             walk.ray.direction, walk.traveled);
  if (is_black(found.radiance)) return;
  float weight = 1;
  if (!walk.specular) {
    const float along =
        vertex.flight.empty() || !hit
            ? 0.0f
            : vertex.along(hit->point.position, lights_.pdf_place(vertex.flight.chosen_for(), *hit,
                                                                  walk.ray.direction, walk.traveled));
    weight = mean(vertex.reached * vertex.direction) / vertex.all(found.light_pdf, vertex.direction, along);
  }
  if (walk.light_paths > 0 && (walk.specular || walk.non_delta_vertices > 1)) {
    if (!hit && walk.specular) {
      walk.add(walk.path.weight() * beside_->background_left(walk.ray, walk.light_paths));
      return;
    }
    const float turned = mean(vertex.direction);
    const float share = walk.specular ? 1.0f : turned / (turned + found.light_pdf);
    weight /= beside_->over_found(walk.light_paths, share, hit, walk.ray, world_.environment());
  }
  walk.add(walk.path.weight() * found.radiance * weight);
}

// Light sampling and the next direction; false ends the path.
bool VolumePathTracer::scatter_on_surface(Walk& walk, const world::SurfaceHit& hit) const {
  const bool may_continue = max_depth_ < 0 || walk.segments < max_depth_;
  const Vec3f wo = -walk.ray.direction;
  const bool by_eye = walk.non_delta_vertices == 0;
  const scatter::MaterialSet& materials = world_.materials();
  Closure closure = materials.closure(by_eye ? materials.seen(hit.material) : hit.material, hit.point, wo);
  if (by_eye) scatter::face_viewer(closure, wo);  // as rows are
  const auto [u_light, u_lobe] = walk.random.next_fine();
  if (closure.has_non_delta() && may_continue) {
    const auto light =
        lights_.sample(world::lit_point(hit.point.position, closure, wo), u_light, walk.random.next_2d());
    const Vec3f wi = light.direct.direction;
    const Rgb f = light.pdf > 0 ? scatter::eval(closure, wo, wi) : Rgb{0};
    if (!is_black(f)) {
      const int medium = world_.medium_beyond(hit, wi, walk.medium);
      const auto random = [&walk] { return walk.random.next_float(); };
      const Rgb visible = world::pass_straight(
          world_, {hit.point.position, hit.point.ng, wi, light.direct.distance, medium}, random);
      const float turned = scatter::pdf(closure, wo, wi, Lobes::all);
      const float pdf = light.direct.delta ? 0.0f : turned;
      ++walk.non_delta_vertices;
      walk.add(walk.path.weight() * f * light.direct.radiance * visible *
               (left_of_sampled(walk, hit.point.position, light, turned) / (light.pdf + pdf)));
      --walk.non_delta_vertices;
    }
  }

  float merge_area = 0;
  if (beside_ && walk.non_delta_vertices == 0 && !walk.from_eye && closure.has_non_delta())
    merge_area = beside_->merge_area(walk.eye_ray, walk.from_camera + walk.traveled, closure);
  if (merge_area > 0 && walk.merge_points && may_continue)
    walk.merge_points->push_back({hit, wo, walk.path.weight(), merge_area, walk.segments});
  const auto next = scatter::sample(closure, wo, u_lobe, walk.random.next_2d(), Lobes::all);
  if (!next || is_black(next->weight)) return false;
  walk.path.multiply(next->weight);
  const bool pass = next->delta && next->kind == LobeKind::delta_pass;
  if (!pass) {
    if (!may_continue) return false;
    if (walk.from_eye && !next->delta)
      walk.light_paths = beside_->ratio_on(walk.ray, walk.traveled, hit, closure, next->wi, next->pdf);
    else if (merge_area > 0 && !next->delta)
      walk.light_paths = beside_->ratio_merged(merge_area, hit, closure, next->wi, next->pdf);
    walk.from_eye = false;
    walk.from_camera += walk.traveled;
    ++walk.segments;
    walk.traveled = 0;
    walk.eta_scale *= next->eta * next->eta;
    walk.specular = next->delta;
    // Not where a path goes straight on: what it finds later is weighted against lights sampled here.
    walk.vertex = {.at = world::lit_point(hit.point.position, closure, wo), .direction = Rgb(next->pdf)};
    if (!next->delta) ++walk.non_delta_vertices;
    if (!survives(walk)) return false;
  }
  walk.medium = world_.medium_beyond(hit, next->wi, walk.medium);
  walk.ray = {world::World::offset_origin(hit.point.position, hit.point.ng, next->wi), normalize(next->wi)};
  return true;
}

// What light paths leave of a light sampled at `place`, where an eye path turns towards it with a density of
// `turned`.
float VolumePathTracer::left_of_sampled(const Walk& walk, Vec3f place,
                                        const world::LightSampler::Sample& light, float turned) const {
  return walk.light_paths > 0 ? 1 / beside_->over_sampled(walk.light_paths, place, light, turned) : 1.0f;
}

// Russian roulette; false ends the path.
bool VolumePathTracer::survives(Walk& walk) const {
  if (walk.segments <= 5) return true;
  const float survival = std::min(0.95f, max_component(walk.path.weight()) * walk.eta_scale);
  if (walk.random.next_float() >= survival) return false;
  walk.path.multiply(Rgb(1 / survival));
  return true;
}

}  // namespace lumirank::pathtrace
