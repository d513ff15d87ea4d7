#include "transport/lights/particle.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "scatter/closure.h"
#include "transport/lights/halves.h"

namespace lumirank::transport {
namespace {

using scatter::Closure;
using scatter::LobeKind;

constexpr double kUsualVertices = 16;  // of a path
constexpr std::size_t kTrialPaths = 256;
// From this depth on a particle survives with the probability below at most: a closed white box absorbs
// nothing.
constexpr int kDeep = 32;
constexpr float kDeepSurvival = 0.9f;
// Of the level at which a path started, or was split: more is not believed. White surfaces of some models
// give back more than they receive (Mitsuba's principled up to a twentieth and more), and between two of them
// a path would gain flux without end, and split without end.
constexpr float kMaxGain = 8;
// A path that waits in this many parts is split no further.
constexpr std::size_t kMaxPending = 256;

// Flux is measured through the geometric surface, but the closure's cosine is that of the shading normal:
// this part of Veach's correction (1997, section 5.3) belongs to the light, the rest to the direction in
// which light leaves it.
float incident_correction(const Closure& closure, Vec3f incoming) {
  if (closure.is_fiber()) return 1;
  return std::abs(dot(incoming, closure.frame.n) / dot(incoming, closure.ng));
}

// All but a closure in the pool: only lights that are kept have one.
LightRecord surface_light(const Vec3f& position, const Closure& closure, Vec3f incoming) {
  LightRecord light;
  light.kind = LightKind::surface;
  light.position = position;
  light.incoming = incoming;
  const float side = dot(closure.frame.n, incoming) < 0 ? -1.0f : 1.0f;
  light.normal = closure.frame.n * side;
  light.ng = closure.ng * side;
  if (closure.is_lambertian()) light.albedo = closure.diffuse_color();
  return light;
}

}  // namespace

EmissionGuide::Start ParticleTracer::trace(std::size_t path, LightBatch& batch, PathTally* tally) const {
  Rng rng(settings_.seed, settings_.stage, settings_.first_id + path);
  const PlaceInHalf place(path, settings_.paths);
  const double u = (static_cast<double>(place.index) + rng.next_double()) / static_cast<double>(place.size);
  const auto start =
      settings_.guide->draw(u, place.index, place.key(settings_.seed ^ settings_.first_id), settings_.stage);
  const std::size_t before = batch.lights.size();
  follow(start, hash_ids(settings_.first_id + path, settings_.stage), rng, batch, tally);
  for (std::size_t k = before; k < batch.lights.size(); ++k) {
    batch.lights[k].half = place.feature();
    batch.lights[k].path = static_cast<std::uint32_t>(path);
  }
  return start;
}

// What the vertices of one path share.
struct ParticleTracer::Visit {
  int emitter;
  Rng& rng;
  LightBatch& batch;
  PathTally* tally;
  bool first = true;
  std::vector<Branch> pending;
};

void ParticleTracer::follow(const EmissionGuide::Start& from, std::uint64_t id, Rng& rng, LightBatch& batch,
                            PathTally* tally) const {
  const auto start = choice_.draw(from.emitter);
  const auto emission = world_.sample_emission(start.emitter, start.remapped, {from.rest[0], from.rest[1]},
                                               {from.rest[2], from.rest[3]});
  const Rgb flux =
      emission.weight *
      static_cast<float>(1 / (start.probability * from.density * static_cast<double>(settings_.paths)));
  const float level = max_component(flux);
  if (!(level > 0)) return;

  geometry::Ray ray{emission.origin, emission.direction};
  if (std::holds_alternative<emitters::AreaEmitter>(
          world_.emitters()[static_cast<std::size_t>(start.emitter)].kind))
    ray.origin = world::World::offset_origin(emission.origin, emission.normal, emission.direction);
  Visit visit{start.emitter, rng, batch, tally, true, {}};
  visit.pending.push_back({ray, flux, level, 1, id});
  while (!visit.pending.empty()) {
    const Branch branch = visit.pending.back();
    visit.pending.pop_back();
    step(branch, visit);
  }
}

void ParticleTracer::step(Branch branch, Visit& visit) const {
  if (branch.depth >= 0xffff) return;
  const auto hit = world_.intersect(branch.ray);
  if (!hit) return;
  if (branch.medium >= 0) branch.flux *= world_.left_by_glass(branch.medium, hit->hit.t);
  if (visit.tally) ++visit.tally->vertices;
  if (visit.tally && visit.first) visit.tally->first_flux += mean(branch.flux);
  visit.first = false;
  const Vec3f incoming = -branch.ray.direction;
  const Closure closure = world_.materials().closure(hit->material, hit->point, incoming);
  // Paths are those of the whole closure either way: only what a light shines itself is another.
  // Widened are the lobes of lights that are kept: for anisotropic ones that takes longer than all else here.
  const Closure shining = settings_.lobes.unwidened().of(closure, incoming);
  int copies = 1;
  if (shining.has_non_delta() && closure.sides_agree(incoming)) {
    LightRecord light = surface_light(hit->point.position, shining, incoming);
    light.power = branch.flux * incident_correction(closure, incoming);
    light.emitter = static_cast<std::uint16_t>(visit.emitter);
    light.id = branch.id;
    light.placement = hit->hit.instance;
    light.behind = dot(hit->point.ng, incoming) < 0;
    light.depth = static_cast<std::uint16_t>(branch.depth);
    if (visit.tally) visit.tally->scattered_flux += mean(branch.flux * scatter::albedo(shining, incoming));
    copies = leave(light, shining, visit);
  }
  // A heavy path goes on as several lighter ones, each by itself.
  const float part = 1 / static_cast<float>(copies);
  for (int copy = 0; copy < copies; ++copy) {
    Branch next = branch;
    next.flux *= part, next.level *= part;
    next.id = mix64(branch.id + 1 + static_cast<std::uint64_t>(copy));
    if (scatter_on(*hit, closure, incoming, next, visit.rng)) visit.pending.push_back(next);
  }
}

// Returns in how many parts the path goes on.
int ParticleTracer::leave(LightRecord& light, const Closure& shining, Visit& visit) const {
  int copies = 1;
  if (settings_.roulette) {
    const double use =
        settings_.roulette->use(light, shining.is_lambertian()) * static_cast<double>(settings_.paths);
    const double keep = settings_.roulette->keep(use);
    if (keep < 1) {
      if (visit.rng.next_double() >= keep) return 1;
      light.power *= static_cast<float>(1 / keep);
    }
    if (visit.pending.size() < kMaxPending && light.depth < kDeep) copies = settings_.roulette->parts(use);
  }
  if (!is_finite(light.power)) return copies;
  if (!shining.is_lambertian())
    light.closure = visit.batch.closures.add(settings_.lobes.of(shining, light.incoming), light.normal);
  visit.batch.lights.push_back(light);
  return copies;
}

// False: the path ends.
bool ParticleTracer::scatter_on(const world::SurfaceHit& hit, const Closure& closure, Vec3f incoming,
                                Branch& branch, Rng& rng) const {
  const float u_lobe = rng.next_float();
  const auto next = scatter::sample(closure, incoming, u_lobe, rng.next_2d(), scatter::Lobes::all, true);
  if (!next) return false;
  Rgb& flux = branch.flux;
  flux *= next->weight;
  if (!next->delta) flux *= scatter::shading_correction(closure, incoming, next->wi);
  const bool passes = next->delta && next->kind == LobeKind::delta_pass;
  if (!passes) ++branch.depth;
  if (settings_.deepest >= 0 && branch.depth > settings_.deepest) return false;
  // Whatever is left above or below the starting level is paid back in the chance to survive, so that all
  // lights of an emitter have about the same power.
  const float gain = max_component(flux) / branch.level;
  if (gain > kMaxGain) flux *= kMaxGain / gain;
  float survival = std::min(1.0f, gain);
  if (branch.depth > kDeep && survival > kDeepSurvival) {
    branch.level *= survival / kDeepSurvival;  // what is paid back for depth is no gain
    survival = kDeepSurvival;
  }
  if (!(survival > 0) || (survival < 1 && rng.next_float() >= survival)) return false;
  flux *= 1 / survival;
  if (!is_finite(flux)) return false;
  branch.medium = world_.medium_beyond(hit, next->wi, branch.medium);
  branch.ray = {world::World::offset_origin(hit.point.position, hit.point.ng, next->wi), next->wi};
  return true;
}

std::size_t paths_worth_tracing(const world::World& world, const world::EmitterChoice& choice,
                                const ParticleSettings& settings) {
  const std::size_t paths = even(settings.paths), trial = std::min(paths, kTrialPaths);
  if (trial == 0) return 0;
  const ParticleTracer tracer(world, choice, settings);
  LightBatch batch;
  PathTally tally;
  for (std::size_t k = 0; k < trial; ++k) tracer.trace(k * paths / trial, batch, &tally);
  const double length = static_cast<double>(tally.vertices) / static_cast<double>(trial);
  if (length <= kUsualVertices) return paths;
  return even(static_cast<std::size_t>(std::ceil(static_cast<double>(paths) * kUsualVertices / length)));
}

}  // namespace lumirank::transport
