#include "transport/lights/ray_lights.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <span>
#include <variant>

#include "base/error.h"
#include "base/morton.h"
#include "base/parallel.h"
#include "base/random.h"
#include "media/tracking.h"
#include "scatter/closure.h"
#include "transport/lights/emitter_lights.h"
#include "transport/lights/halves.h"
#include "transport/lights/light_areas.h"
#include "transport/lights/light_record.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kMediaPathsPerPiece = 1024;
constexpr std::size_t kMediaPilotPaths = 1024;
// From this depth on a particle survives with the probability below at most: a white medium absorbs nothing.
constexpr int kDeepInMedia = 32;
constexpr float kDeepInMediaSurvival = 0.9f;
// A bound on straight passes and vertices of one particle.
constexpr int kMaxSteps = 1 << 16;

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

struct MediaBatch {
  LightBatch points;
  std::vector<RayRecord> rays;
};

class ParticlesInMedia {
 public:
  ParticlesInMedia(const world::World& world, const world::EmitterChoice& choice,
                   const MediaLightSettings& settings, Stage stage, std::size_t paths, int deepest)
      : world_(world),
        choice_(choice),
        settings_(settings),
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
               .level = max_component(flux),
               .id = hash_ids(path, stage_),
               .rng = rng,
               .batch = batch};
    p.path.multiply(flux);
    p.hero = static_cast<int>(p.rng.next_below(3));
    p.emitter = static_cast<std::uint16_t>(start.emitter);
    p.number = static_cast<std::uint32_t>(path);
    p.half = place.feature();
    if (std::holds_alternative<emitters::AreaEmitter>(
            world_.emitters()[static_cast<std::size_t>(start.emitter)].kind))
      p.ray.origin = world::World::offset_origin(emission.origin, emission.normal, emission.direction);
    p.medium = world_.medium_around(p.ray, settings_.eye_medium);
    for (int step = 0; step < kMaxSteps && advance(p); ++step) {
    }
  }

 private:
  struct Particle {
    geometry::Ray ray;
    media::ChannelThroughput path = {};
    float level;  // of flux: less is paid in the chance to survive
    int hero = 0, medium = -1;
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
    float survival = std::min(1.0f, max_component(p.path.weight()) / p.level);
    if (p.depth > kDeepInMedia) survival = std::min(survival, kDeepInMediaSurvival);
    if (!(survival > 0) || (survival < 1 && p.rng.next_float() >= survival)) return false;
    p.path.multiply(Rgb(1 / survival));
    return is_finite(p.path.weight());
  }

  // To the next vertex or through the next surface; false ends the particle.
  bool advance(Particle& p) const {
    const auto hit = world_.intersect(p.ray);
    if (p.medium >= 0) {
      const media::Medium& medium = world_.media()[static_cast<std::size_t>(p.medium)];
      const float to_the_end = length(p.ray.origin - world_.bounds().center()) + world_.bounds().radius();
      const float way = hit ? hit->hit.t : to_the_end;
      if (medium.scatters()) leave_ray(p, way);
      const Flight flight = fly(p, medium, hit ? way : kInfinity);
      if (flight != Flight::arrived) return flight == Flight::scattered;
    }
    return hit && meet(p, *hit);
  }

  void leave_ray(Particle& p, float way) const {
    RayRecord ray{p.ray.origin,
                  p.ray.direction,
                  way,
                  static_cast<std::int16_t>(p.medium),
                  p.path.weight(),
                  p.emitter,
                  static_cast<std::uint16_t>(std::min(p.depth, 0xffff)),
                  p.number,
                  p.half,
                  mix64(p.id ^ 0x7261797eull)};
    if (way > 0 && is_finite(ray.power)) p.batch.rays.push_back(ray);
  }

  enum class Flight { arrived, scattered, ended };
  Flight fly(Particle& p, const media::Medium& medium, float way) const {
    const auto random = [&p] { return p.rng.next_float(); };
    const Vec3f origin = p.ray.origin, forward = p.ray.direction;
    bool collided = false, goes = false;
    const bool arrived = media::fly(medium, origin, forward, way, p.hero, random, p.path,
                                    [&](float t, const media::Coefficients& at, Rgb bound) {
                                      const Rgb null = bound - at.extinction;
                                      if (random() * bound[p.hero] >= at.extinction[p.hero]) {
                                        if (null[p.hero] > 0) p.path.event(null, null, p.hero);
                                        return true;
                                      }
                                      collided = true;
                                      p.path.event(at.scattering, at.extinction, p.hero);
                                      if (is_black(at.scattering)) return false;
                                      const float u_lobe = random();
                                      const Vec3f next =
                                          medium.phase().sample(forward, p.hero, u_lobe, p.rng.next_2d());
                                      const Rgb f = medium.phase().eval(dot(forward, next));
                                      if (!(f[p.hero] > 0)) return false;
                                      p.path.event(f, f, p.hero);
                                      p.ray = {origin + forward * t, next};
                                      goes = goes_on(p);
                                      return false;
                                    });
    if (arrived) return Flight::arrived;
    return collided && goes ? Flight::scattered : Flight::ended;
  }

  bool meet(Particle& p, const world::SurfaceHit& hit) const {
    const Vec3f incoming = -p.ray.direction;
    const scatter::Closure closure = world_.materials().closure(hit.material, hit.point, incoming);
    if (closure.has_non_delta() && closure.sides_agree(incoming)) leave_point(p, hit, closure, incoming);
    const float u_lobe = p.rng.next_float();
    const auto next = scatter::sample(closure, incoming, u_lobe, p.rng.next_2d(), scatter::Lobes::all, true);
    if (!next) return false;
    p.path.multiply(next->weight);
    if (!next->delta) p.path.multiply(Rgb(scatter::shading_correction(closure, incoming, next->wi)));
    const bool passes = next->delta && next->kind == scatter::LobeKind::delta_pass;
    p.medium = world_.medium_beyond(hit, next->wi, p.medium);
    p.ray = {world::World::offset_origin(hit.point.position, hit.point.ng, next->wi), normalize(next->wi)};
    return passes ? !is_black(p.path.throughput) : goes_on(p);
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
    light.power = p.path.weight() * correction;
    if (!is_finite(light.power)) return;
    light.emitter = p.emitter;
    light.id = p.id;
    light.depth = static_cast<std::uint16_t>(std::min(p.depth, 0xffff));
    light.path = p.number, light.half = p.half;
    if (closure.is_lambertian())
      light.albedo = closure.diffuse_color();
    else
      light.closure = p.batch.points.closures.add(closure, light.normal);
    p.batch.points.lights.push_back(light);
  }

  const world::World& world_;
  const world::EmitterChoice& choice_;
  const MediaLightSettings& settings_;
  Stage stage_;
  std::size_t paths_;
  int deepest_;
};

void trace_all(const ParticlesInMedia& particles, std::size_t paths, std::span<MediaBatch> batches,
               const Sinks& sinks) {
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

// Along a Morton curve by their middles, so that neighbors are alike.
RayLights laid_out(std::span<const MediaBatch> batches) {
  std::vector<RayRecord> all;
  for (const MediaBatch& batch : batches) all.insert(all.end(), batch.rays.begin(), batch.rays.end());
  Bounds3f box;
  const auto middle = [](const RayRecord& r) { return r.origin + r.direction * (0.5f * r.length); };
  for (const RayRecord& r : all) box.extend(middle(r));
  const auto code = [&](Vec3f p) {
    std::uint32_t cell[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float size = box.hi[axis] - box.lo[axis];
      cell[axis] = size > 0 ? static_cast<std::uint32_t>((p[axis] - box.lo[axis]) / size * 2097151.0f) : 0;
    }
    return morton3(cell[0], cell[1], cell[2]);
  };
  std::vector<std::uint64_t> codes(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) codes[k] = code(middle(all[k]));
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return codes[a] < codes[b]; });
  RayLights out;
  for (const std::size_t k : order) {
    const RayRecord& r = all[k];
    out.origin.push_back(r.origin), out.direction.push_back(r.direction), out.length.push_back(r.length);
    out.medium.push_back(r.medium), out.power.push_back(r.power), out.emitter.push_back(r.emitter);
    out.depth.push_back(r.depth), out.path.push_back(r.path), out.half.push_back(r.half),
        out.id.push_back(r.id);
  }
  return out;
}

std::size_t lights_in(std::span<const MediaBatch> batches) {
  std::size_t count = 0;
  for (const MediaBatch& batch : batches) count += batch.points.lights.size() + batch.rays.size();
  return count;
}

// As MediaLightSettings::least_direct says. What shines from infinitely far is taken to light a disc of the
// scene's size.
void repeat(std::vector<LightRecord>& lights, std::size_t least, float radius) {
  const auto sent = [&](const LightRecord& light) {
    const float area = light.kind == LightKind::directional ? kPi * radius * radius : 4 * kPi;
    return static_cast<double>(area * mean(light.power));
  };
  double all = 0;
  for (const LightRecord& light : lights) all += sent(light);
  if (!(all > 0)) return;
  const std::size_t own = lights.size();
  for (std::size_t j = 0; j < own; ++j) {
    const double parts = static_cast<double>(least) * sent(lights[j]) / all;
    const auto copies = static_cast<std::size_t>(std::max(1.0, std::ceil(parts)));
    lights[j].power *= 1 / static_cast<float>(copies);
    for (std::size_t copy = 1; copy < copies; ++copy) {
      lights.push_back(lights[j]);
      lights.back().id = mix64(lights[j].id + copy);
    }
  }
}

}  // namespace

LightsInMedia trace_lights_in_media(const world::World& world, const MediaLightSettings& settings,
                                    const Sinks& sinks) {
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
    repeat(points[0].lights, settings.least_direct, world.bounds().radius());
    out.points.direct_count = points[0].lights.size();
  }
  std::vector<MediaBatch> batches;
  std::size_t paths = 0;
  if (indirect) {
    const auto pieces = [](std::size_t count) {
      return (count + kMediaPathsPerPiece - 1) / kMediaPathsPerPiece;
    };
    std::vector<MediaBatch> pilot(pieces(kMediaPilotPaths));
    trace_all(ParticlesInMedia(world, choice, settings, Stage::pilot, kMediaPilotPaths, deepest),
              kMediaPilotPaths, pilot, {});
    const double each = static_cast<double>(lights_in(pilot)) / kMediaPilotPaths;
    const double rest =
        static_cast<double>(std::max<std::size_t>(1, settings.count > direct ? settings.count - direct : 1));
    paths = each > 0 ? static_cast<std::size_t>(std::ceil(rest / each)) : 0;
    batches.resize(pieces(paths));
    if (paths > 0)
      trace_all(ParticlesInMedia(world, choice, settings, Stage::particles, paths, deepest), paths, batches,
                sinks);
  }
  out.rays = laid_out(batches);
  for (MediaBatch& batch : batches) points.push_back(std::move(batch.points));
  const std::size_t direct_count = out.points.direct_count;
  out.points = lay_out(points);
  out.points.paths = paths, out.points.direct_count = direct_count;
  measure_areas(out.points, world.bounds().radius());
  return out;
}

}  // namespace lumirank::transport
