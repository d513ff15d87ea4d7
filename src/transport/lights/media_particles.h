// Particles through media, and the rays and points that they leave, whatever they carry: light in one world
// (ray_lights.cpp) or in several at once (lights_of_moments.cpp).
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "scatter/closure.h"
#include "transport/lights/emitter_lights.h"
#include "transport/lights/halves.h"
#include "transport/lights/light_areas.h"
#include "transport/lights/light_record.h"
#include "transport/lights/ray_lights.h"
#include "world/emitter_media.h"

namespace lumirank::transport {

struct RayRecord {
  Vec3f origin, direction;
  float length;
  std::int16_t medium;
  Rgb power;
  std::uint16_t emitter, depth;
  std::uint32_t path;
  std::uint8_t half;
  std::uint64_t id;
};

// What is noted of a light's power in each world, where there are several.
struct PowersOfLight {
  std::uint64_t id;
  std::size_t first;  // in MediaBatch::powers
};

struct MediaBatch {
  LightBatch points;
  std::vector<RayRecord> rays;
  std::vector<PowersOfLight> known;
  std::vector<Rgb> powers;
};

std::size_t lights_in(std::span<const MediaBatch> batches);
// Along a Morton curve by their middles, so that neighbors are alike.
RayLights lay_out_rays(std::span<const MediaBatch> batches);
// As MediaLightSettings::least_direct says. What shines from infinitely far is taken to light a disc of the
// scene's size.
void repeat_emitters(std::vector<LightRecord>& lights, std::size_t least, float radius);

// A flight's end: at the surface; at a place in the medium, which it leaves; nowhere.
enum class Flight : std::uint8_t { arrived, scattered, ended };

// `Carried`: what one particle carries. With `using Shared`, what all of them share:
//   Carried(const Shared&, Rng&)
//   multiply(Rgb), weight(): by what its light is multiplied so far; of several worlds the greatest
//   note(id, factor, batch): of a light of that id and weight() · factor, what else is to be known
//   scatters(medium): whether it may, somewhere
//   fly(medium, ray, way, rng) -> Flight: to the surface or to where it collides; `ray` then goes on from
//   there.
template <typename Carried>
class ParticlesInMedia {
 public:
  ParticlesInMedia(const typename Carried::Shared& shared, const world::EmitterChoice& choice,
                   const MediaLightSettings& settings, Stage stage, std::size_t paths, int deepest)
      : shared_(shared),
        world_(shared.world()),
        choice_(choice),
        settings_(settings),
        emitter_media_(shared.world(), settings.eye, settings.eye_medium),
        stage_(stage),
        paths_(paths),
        deepest_(deepest) {}

  void trace(std::size_t path, MediaBatch& batch) const {
    Rng rng(settings_.seed, stage_, path);
    const PlaceInHalf place(path, paths_);
    const double u = (static_cast<double>(place.index) + rng.next_double()) / static_cast<double>(place.size);
    const auto start = choice_.draw(u);
    const float u1 = start.remapped;
    const Vec2f where = rng.next_2d(), whither = rng.next_2d();
    const auto emission = world_.sample_emission(start.emitter, u1, where, whither);
    const Rgb flux =
        emission.weight * static_cast<float>(1 / (start.probability * static_cast<double>(paths_)));
    if (!(max_component(flux) > 0) || !is_finite(flux)) return;
    Particle p{.ray = {emission.origin, normalize(emission.direction)},
               .carried = Carried(shared_, rng),
               .level = max_component(flux),
               .id = hash_ids(path, stage_),
               .rng = rng,
               .batch = batch};
    p.carried.multiply(flux);
    p.emitter = static_cast<std::uint16_t>(start.emitter);
    p.number = static_cast<std::uint32_t>(path);
    p.half = place.feature();
    if (std::holds_alternative<emitters::AreaEmitter>(
            world_.emitters()[static_cast<std::size_t>(start.emitter)].kind))
      p.ray.origin = world::World::offset_origin(emission.origin, emission.normal, emission.direction);
    p.medium = emitter_media_.of(start.emitter, p.ray);
    for (int step = 0; step < kMaxSteps && advance(p); ++step) {
    }
  }

 private:
  struct Particle {
    geometry::Ray ray;
    Carried carried;
    float level;  // of flux: less is paid in the chance to survive
    int medium = -1;
    int depth = 1;  // of the next vertex
    std::uint16_t emitter = 0;
    std::uint32_t number = 0;
    std::uint8_t half = 0;
    std::uint64_t id;
    Rng rng;
    MediaBatch& batch;
  };

  // Russian roulette at a vertex that the particle leaves.
  bool goes_on(Particle& p) const {
    ++p.depth;
    if (deepest_ >= 0 && p.depth > deepest_) return false;
    p.id = mix64(p.id + 1);
    float survival = std::min(1.0f, max_component(p.carried.weight()) / p.level);
    if (p.depth > kDeepInMedia) survival = std::min(survival, kDeepInMediaSurvival);
    if (!(survival > 0) || (survival < 1 && p.rng.next_float() >= survival)) return false;
    p.carried.multiply(Rgb(1 / survival));
    return is_finite(p.carried.weight());
  }

  // To the next vertex or through the next surface; false ends the particle.
  bool advance(Particle& p) const {
    const auto hit = world_.intersect(p.ray);
    if (p.medium >= 0) {
      const float to_the_end = length(p.ray.origin - world_.bounds().center()) + world_.bounds().radius();
      const float way = hit ? hit->hit.t : to_the_end;
      if (p.carried.scatters(p.medium)) leave_ray(p, way);
      const Flight flight = p.carried.fly(p.medium, p.ray, hit ? way : kInfinity, p.rng);
      if (flight != Flight::arrived) return flight == Flight::scattered && goes_on(p);
    }
    return hit && meet(p, *hit);
  }

  void leave_ray(Particle& p, float way) const {
    RayRecord ray{p.ray.origin,
                  p.ray.direction,
                  way,
                  static_cast<std::int16_t>(p.medium),
                  p.carried.weight(),
                  p.emitter,
                  static_cast<std::uint16_t>(std::min(p.depth, 0xffff)),
                  p.number,
                  p.half,
                  mix64(p.id ^ 0x7261797eull)};
    if (!(way > 0) || !is_finite(ray.power)) return;
    p.carried.note(ray.id, 1, p.batch);
    p.batch.rays.push_back(ray);
  }

  bool meet(Particle& p, const world::SurfaceHit& hit) const {
    const Vec3f incoming = -p.ray.direction;
    const scatter::Closure closure = world_.materials().closure(hit.material, hit.point, incoming);
    if (closure.has_non_delta() && closure.sides_agree(incoming)) leave_point(p, hit, closure, incoming);
    const float u_lobe = p.rng.next_float();
    const auto next = scatter::sample(closure, incoming, u_lobe, p.rng.next_2d(), scatter::Lobes::all, true);
    if (!next) return false;
    p.carried.multiply(next->weight);
    if (!next->delta) p.carried.multiply(Rgb(scatter::shading_correction(closure, incoming, next->wi)));
    const bool passes = next->delta && next->kind == scatter::LobeKind::delta_pass;
    p.medium = world_.medium_beyond(hit, next->wi, p.medium);
    p.ray = {world::World::offset_origin(hit.point.position, hit.point.ng, next->wi), normalize(next->wi)};
    return passes ? !is_black(p.carried.weight()) : goes_on(p);
  }

  void leave_point(Particle& p, const world::SurfaceHit& hit, const scatter::Closure& closure,
                   Vec3f incoming) const {
    LightRecord light;
    light.kind = LightKind::surface;
    light.position = hit.point.position;
    light.incoming = incoming;
    const float side = dot(closure.frame.n, incoming) < 0 ? -1.0f : 1.0f;
    light.normal = closure.frame.n * side, light.ng = closure.ng * side;
    // As in particle.cpp: flux is measured through the geometric surface.
    const float correction =
        closure.is_fiber() ? 1.0f : std::abs(dot(incoming, closure.frame.n) / dot(incoming, closure.ng));
    light.power = p.carried.weight() * correction;
    if (!is_finite(light.power)) return;
    light.emitter = p.emitter;
    light.id = p.id;
    light.depth = static_cast<std::uint16_t>(std::min(p.depth, 0xffff));
    light.path = p.number, light.half = p.half;
    p.carried.note(light.id, correction, p.batch);
    if (closure.is_lambertian())
      light.albedo = closure.diffuse_color();
    else
      light.closure = p.batch.points.closures.add(closure, light.normal);
    p.batch.points.lights.push_back(light);
  }

  // A bound on straight passes and vertices of one particle.
  static constexpr int kMaxSteps = 1 << 16;
  // From this depth on a particle survives with the probability below at most: a white medium absorbs
  // nothing.
  static constexpr int kDeepInMedia = 32;
  static constexpr float kDeepInMediaSurvival = 0.9f;

  const typename Carried::Shared& shared_;
  const world::World& world_;
  const world::EmitterChoice& choice_;
  const MediaLightSettings& settings_;
  world::EmitterMedia emitter_media_;
  Stage stage_;
  std::size_t paths_;
  int deepest_;
};

inline constexpr std::size_t kMediaPathsPerPiece = 1024, kMediaPilotPaths = 1024;

template <typename Carried>
void trace_in_media(const ParticlesInMedia<Carried>& particles, std::size_t paths,
                    std::span<MediaBatch> batches, const Sinks& sinks) {
  std::atomic<std::size_t> done{0};
  parallel_for(paths, kMediaPathsPerPiece, [&](std::size_t begin, std::size_t end) {
    if (sinks.cancelled()) return;
    for (std::size_t path = begin; path < end; ++path)
      particles.trace(path, batches[begin / kMediaPathsPerPiece]);
    done += end - begin;
    sinks.report("virtual lights", static_cast<double>(done) / static_cast<double>(paths));
  });
  if (sinks.cancelled()) throw Cancelled();
}

// As trace_lights_in_media(); `batches` is left with what was noted.
template <typename Carried>
LightsInMedia trace_lights_carrying(const typename Carried::Shared& shared,
                                    const MediaLightSettings& settings, std::vector<MediaBatch>& batches,
                                    const Sinks& sinks) {
  const world::World& world = shared.world();
  if (settings.count < 1) throw InputError("the number of virtual lights is 0", "ask for at least 1");
  const world::EmitterChoice choice(world);
  LightsInMedia out;
  if (choice.empty()) return out;
  // A light of depth d is seen over two more segments: to the row, and from there to the eye. A ray light's
  // scattering is a vertex of its own, so its last segment counts among these.
  const int deepest = settings.max_depth < 0 ? -1 : std::max(0, settings.max_depth - 2);
  const bool indirect = settings.indirect && deepest != 0;
  std::vector<LightBatch> points;
  const DirectNeed need = direct_need(world, choice);
  std::size_t direct = 0;
  if (settings.direct) {
    const std::size_t wanted = indirect ? std::max<std::size_t>(1, settings.count / 4) : settings.count;
    direct = std::max(need.min_count, need.sampled ? wanted : need.min_count);
    points.push_back(emitter_lights(world, choice, settings.seed, direct));
    repeat_emitters(points[0].lights, settings.least_direct, world.bounds().radius());
    out.points.direct_count = points[0].lights.size();
  }
  std::size_t paths = 0;
  if (indirect) {
    const auto pieces = [](std::size_t count) {
      return (count + kMediaPathsPerPiece - 1) / kMediaPathsPerPiece;
    };
    std::vector<MediaBatch> pilot(pieces(kMediaPilotPaths));
    trace_in_media(
        ParticlesInMedia<Carried>(shared, choice, settings, Stage::pilot, kMediaPilotPaths, deepest),
        kMediaPilotPaths, pilot, {});
    const double each = static_cast<double>(lights_in(pilot)) / kMediaPilotPaths;
    const double rest =
        static_cast<double>(std::max<std::size_t>(1, settings.count > direct ? settings.count - direct : 1));
    paths = each > 0 ? static_cast<std::size_t>(std::ceil(rest / each)) : 0;
    batches.resize(pieces(paths));
    if (paths > 0)
      trace_in_media(ParticlesInMedia<Carried>(shared, choice, settings, Stage::particles, paths, deepest),
                     paths, batches, sinks);
  }
  out.rays = lay_out_rays(batches);
  for (MediaBatch& batch : batches) points.push_back(std::move(batch.points));
  const std::size_t direct_count = out.points.direct_count;
  out.points = lay_out(points);
  out.points.paths = paths, out.points.direct_count = direct_count;
  measure_areas(out.points, world.bounds().radius());
  return out;
}

}  // namespace lumirank::transport
