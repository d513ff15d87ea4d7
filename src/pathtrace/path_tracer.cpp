#include "pathtrace/path_tracer.h"

#include <optional>

#include "pathtrace/found_emission.h"
#include "scatter/closure.h"

namespace lumirank::pathtrace {

using scatter::Closure;
using scatter::LobeKind;
using scatter::Lobes;

// Before roulette begins.
constexpr int kSafeSegments = 3, kSafeSegmentsOfDeparted = 5;

// The state of a path between two vertices.
struct PathTracer::Walk {
  SampleStream random;
  std::uint64_t key;
  geometry::Ray ray;
  Rgb throughput{1};
  int segments = 1;             // traced so far, the current one included; straight passes do not count
  int non_delta_vertices = 0;   // non-specular vertices passed
  bool after_receiver = false;  // the vertex that comes next is the first one after the receiver
  bool departed = false;        // begun at the receiver: what it sees shining does not count
  bool counts;                  // whether light found now belongs to the wanted paths
  bool specular = true;  // the last vertex was specular (or the eye): light sampling could not find this hit
  float bsdf_pdf = 0;    // of the direction taken at the last non-delta vertex
  emitters::LitPoint from{};    // that vertex
  float traveled = 0;           // since the last vertex
  float receiver_term = 0;      // π f_x·cosθx of the step away from the receiver
  const Reach* near = nullptr;  // what may come next after the receiver, see Departure
  int medium = -1;              // that colors the glass which the path is in; -1: none
  float eta_scale = 1;          // undoes refraction's scaling for Russian roulette
  bool from_eye = false;        // the eye sees the vertex that comes next
  // Of the light that will be drawn at the next vertex that is no mirror and no smooth glass.
  std::optional<world::LightSampler::Ahead> light{};
  float light_paths = 0;  // ratio of light paths at the first vertex that is not specular; 0: none
  geometry::Ray eye_ray{};
  float from_camera = 0;  // way from the camera to the last vertex
  std::vector<MergePoint>* merge_points = nullptr;
  // Where the current segment ends, and if nowhere, its place on the environment's map.
  bool seen = false;  // by nothing but the eye
  std::optional<geometry::Hit> met{};
  std::optional<world::SurfaceHit> hit{};
  std::optional<Vec2f> on_map{};
  Radiance sum{};

  void add(Rgb value) {
    if (!counts) return;
    Rgb& part =
        non_delta_vertices == 0 ? sum.emission : (non_delta_vertices == 1 ? sum.direct : sum.indirect);
    part += value;
  }
};

PathTracer::PathTracer(const world::World& world, const PathSettings& settings)
    : world_(world), lights_(world.light_sampler()), settings_(settings) {}

PathTracer::Walk PathTracer::begin(const Start& start) const {
  return {.random = SampleStream::over_film(settings_.seed, Stage::reference, 0, start.place, start.sample),
          .key = hash_ids(settings_.seed, Stage::opacity, start.place, start.sample),
          .ray = start.ray,
          .counts = settings_.paths != Paths::rest,
          .from_eye = beside_.has_value(),
          .eye_ray = start.ray,
          .merge_points = start.merge_points};
}

Radiance PathTracer::trace(geometry::Ray ray, std::uint32_t place, std::uint64_t sample,
                           std::vector<MergePoint>* merge_points) const {
  const Start start{ray, place, sample, merge_points};
  Radiance found;
  trace({&start, 1}, {&found, 1});
  return found;
}

void PathTracer::trace(std::span<const Start> starts, std::span<Radiance> found) const {
  std::vector<Walk> walks;
  walks.reserve(starts.size());
  for (const Start& start : starts) walks.push_back(begin(start));
  finish(walks);
  for (std::size_t k = 0; k < walks.size(); ++k) {
    found[k] = walks[k].sum;
    found[k].segments = walks[k].segments;
  }
}

Rgb PathTracer::indirect_after(const Departure& departure, SampleStream random, std::uint64_t key) const {
  const scatter::BsdfSample& next = departure.next;
  Walk walk{.random = random,
            .key = key,
            .ray = {world::World::offset_origin(departure.position, departure.ng, next.wi), next.wi},
            .throughput = next.weight,
            .segments = departure.depth + 1,
            .non_delta_vertices = 1,
            .after_receiver = true,
            .departed = true,
            .counts = false,
            .specular = false,
            .bsdf_pdf = next.pdf,
            .from = departure.from,
            .near = departure.near,
            .eta_scale = next.eta * next.eta};
  if (walk.near && settings_.paths == Paths::columns) walk.ray.t_max = walk.near->max;
  finish({&walk, 1});
  return walk.sum.direct + walk.sum.indirect;
}

// Step by step for all paths. Each step asks memory for what the next one reads: what paths meet, the corners
// of triangles, texels and lights lie anywhere in it.
void PathTracer::finish(std::span<Walk> walks) const {
  // A bound on straight passes, so that coincident null surfaces cannot hold a path for ever.
  constexpr int kMaxSteps = 4096;
  std::vector<Walk*> live;
  for (Walk& walk : walks) live.push_back(&walk);
  for (int step = 0; step < kMaxSteps && !live.empty(); ++step) {
    for (Walk* walk : live) meet(*walk);
    for (Walk* walk : live) fetch(*walk);
    std::erase_if(live, [&](Walk* walk) { return !arrive(*walk); });
    std::erase_if(live, [&](Walk* walk) { return !leave(*walk); });
  }
}

void PathTracer::meet(Walk& walk) const {
  if (!walk.light) walk.light = lights_.fetch(walk.random.next_2d());
  walk.seen = walk.segments == 1;
  walk.hit.reset(), walk.on_map.reset();
  if (walk.seen && world_.hides_emitters()) {
    walk.hit = world_.intersect_from_eye(walk.ray);
    walk.met = walk.hit ? std::optional(walk.hit->hit) : std::nullopt;
  } else {
    walk.met = world_.rays().intersect(walk.ray);
  }
  if (walk.met) world_.rays().mesh(walk.met->mesh).fetch_indices(walk.met->triangle);
}

void PathTracer::fetch(Walk& walk) const {
  if (walk.met) {
    lights_.fetch_column(*walk.light);
    world_.rays().mesh(walk.met->mesh).fetch_corners(walk.met->triangle);
  } else if (!(walk.seen && world_.hides_emitters())) {
    walk.on_map = lights_.fetch_background(walk.ray.direction);
  }
}

// The surface and what shines there; false ends the path.
bool PathTracer::arrive(Walk& walk) const {
  if (!walk.met && walk.seen && world_.hides_emitters()) return false;
  if (walk.met) {
    if (!walk.hit) walk.hit = world_.surface(*walk.met, walk.ray.direction);
    walk.traveled += walk.met->t;
    if (walk.medium >= 0) {
      walk.throughput *= world_.left_by_glass(walk.medium, walk.met->t * length(walk.ray.direction));
      if (is_black(walk.throughput)) return false;
    }
  }
  add_emission(walk);
  if (!walk.hit) return false;
  lights_.fetch_texel(*walk.light);
  world_.materials().fetch(walk.hit->material, walk.hit->point.uv);
  return true;
}

// On from the surface; false ends the path.
bool PathTracer::leave(Walk& walk) const {
  const world::SurfaceHit& hit = *walk.hit;
  const bool by_eye = walk.non_delta_vertices == 0;
  // Panes that let light pass straight are glass to the eye, as for rows.
  const int material = by_eye ? world_.materials().seen(hit.material) : hit.material;
  if (settings_.max_depth >= 0 && walk.segments >= settings_.max_depth) {
    // No further segment may follow, but a straight pass is no segment.
    if (world_.materials().passage(material) == scatter::MaterialSet::Passage::opaque) return false;
  }
  Closure closure = world_.materials().closure(material, hit.point, -walk.ray.direction);
  if (by_eye) scatter::face_viewer(closure, -walk.ray.direction);  // as rows are
  return scatter(walk, hit, closure);
}

// What shines at the end of the current segment, weighted against light sampling (balance heuristic).
void PathTracer::add_emission(Walk& walk) const {
  const world::SurfaceHit* hit = walk.hit ? &*walk.hit : nullptr;
  const FoundEmission found = found_emission(world_, lights_, walk.specular ? nullptr : &walk.from, hit,
                                             walk.ray.direction, walk.traveled, walk.on_map);
  if (is_black(found.radiance)) return;
  float weight = walk.specular ? 1.0f : walk.bsdf_pdf / (walk.bsdf_pdf + found.light_pdf);
  if (walk.light_paths > 0 && (walk.specular || walk.non_delta_vertices > 1)) {
    if (!hit && walk.specular) {
      walk.add(walk.throughput * beside_->background_left(walk.ray, walk.light_paths));
      return;
    }
    weight /= beside_->over_found(walk.light_paths, weight, hit, walk.ray, world_.environment());
  }
  walk.add(walk.throughput * found.radiance * weight);
}

void PathTracer::sample_lights(Walk& walk, const world::SurfaceHit& hit, const Closure& closure,
                               double u_light, float connection) const {
  const Vec3f wo = -walk.ray.direction;
  const auto s =
      lights_.sample_ahead(world::lit_point(hit.point.position, closure, wo), u_light, *walk.light);
  walk.light.reset();
  if (!(s.pdf > 0)) return;
  Rgb f = scatter::eval(closure, wo, s.direct.direction);
  if (connection > 0) f *= missing(connection, closure, wo, s.direct.direction);
  if (is_black(f)) return;
  const Rgb visible =
      world::visible_fraction(world_, hit.point.position, hit.point.ng, s.direct.direction, s.direct.distance,
                              mix64(walk.key + static_cast<std::uint64_t>(walk.segments)));
  if (is_black(visible)) return;
  float turned = 0, share = 1;
  if (!s.direct.delta || walk.light_paths > 0)
    turned = scatter::pdf(closure, wo, s.direct.direction, Lobes::all);
  const float bsdf_pdf = s.direct.delta ? 0.0f : turned;
  if (walk.light_paths > 0)
    share = 1 / beside_->over_sampled(walk.light_paths, hit.point.position, s, turned);
  walk.add(walk.throughput * f * s.direct.radiance * visible * (share / (s.pdf + bsdf_pdf)));
}

Rgb PathTracer::missing(float connection, const Closure& closure, Vec3f wo, Vec3f wi) const {
  const Rgb f = scatter::eval_f(closure, wo, wi);
  const Rgb light =
      settings_.carried.diffuse_only ? scatter::eval_f(scatter::broad_part(closure, 1), wo, wi) : f;
  const float top = connection * kPi * max_component(light);
  if (!(top > 0)) return Rgb(1);
  const float share = std::min(1.0f, settings_.carried.bound / top);
  Rgb part{0};
  for (int c = 0; c < 3; ++c)
    if (f[c] > 0) part[c] = std::max(0.0f, 1 - share * light[c] / f[c]);
  return part;
}

void PathTracer::keep_traced_lobes(const Walk& walk, const world::SurfaceHit& hit, Closure& closure) const {
  // Columns carry this vertex's non-delta lobes, the rest its specular ones; both pass straight through.
  const bool keep_specular = settings_.paths != Paths::columns, keep_others = settings_.paths != Paths::rest;
  const Vec3f place = hit.point.position;
  const bool counts = !walk.near || length_squared(place - walk.from.position) < square(walk.near->at(place));
  int kept = 0;
  for (int k = 0; k < closure.count; ++k) {
    const LobeKind kind = closure.lobes[k].kind;
    if (kind == LobeKind::delta_pass || (scatter::is_delta(kind) ? keep_specular : keep_others && counts))
      closure.lobes[kept++] = closure.lobes[k];
  }
  closure.count = kept;
}

// Russian roulette; false ends the path. Paths that depart from a receiver are a small part of what it takes,
// and their noise is all the picture's.
bool PathTracer::survives(Walk& walk) const {
  const float survival = std::min(0.95f, max_component(walk.throughput) * walk.eta_scale);
  if (walk.segments <= (walk.departed ? kSafeSegmentsOfDeparted : kSafeSegments)) return true;
  if (walk.random.next_float() >= survival) return false;
  walk.throughput *= 1 / survival;
  return true;
}

// Light sampling and the next direction; false ends the path.
bool PathTracer::scatter(Walk& walk, const world::SurfaceHit& hit, Closure& closure) const {
  const bool may_continue = settings_.max_depth < 0 || walk.segments < settings_.max_depth;
  const bool first_after_receiver = walk.after_receiver;
  if (first_after_receiver && (settings_.paths != Paths::all || walk.near))
    keep_traced_lobes(walk, hit, closure);
  float connection = 0;
  if (first_after_receiver && settings_.carried.bound > 0)
    connection = walk.receiver_term *
                 (closure.is_fiber() ? closure.cosine(walk.ray.direction)
                                     : std::abs(dot(hit.point.ng, walk.ray.direction))) /
                 square(walk.traveled);
  const bool first_of_departed = first_after_receiver && walk.departed;
  if (first_of_departed) walk.counts = true;
  const auto [u_light, u_lobe] = walk.random.next_fine();
  if (closure.has_non_delta() && may_continue) {
    // The vertex itself is non-specular for light that is found here.
    ++walk.non_delta_vertices;
    sample_lights(walk, hit, closure, u_light, connection);
    --walk.non_delta_vertices;
  }

  const Vec3f wo = -walk.ray.direction;
  // Behind what is specular alone, a departed walk not being of these.
  float merge_area = 0;
  if (beside_ && walk.non_delta_vertices == 0 && !walk.from_eye && closure.has_non_delta())
    merge_area = beside_->merge_area(walk.eye_ray, walk.from_camera + walk.traveled, closure);
  if (merge_area > 0 && walk.merge_points && may_continue)
    walk.merge_points->push_back({hit, wo, walk.throughput, merge_area, walk.segments});
  const auto next = scatter::sample(closure, wo, u_lobe, walk.random.next_2d(), Lobes::all);
  if (!next || is_black(next->weight)) return false;
  walk.throughput *= next->weight;
  const bool pass = next->delta && next->kind == LobeKind::delta_pass;
  if (!pass) {
    if (!may_continue) return false;
    if (walk.non_delta_vertices == 0 && !next->delta)
      walk.light_paths = light_paths_at(walk, hit, closure, *next, merge_area);
    walk.from_eye = false;
    walk.from_camera += walk.traveled;
    ++walk.segments;
    walk.traveled = 0;
    walk.eta_scale *= next->eta * next->eta;
    walk.specular = next->delta;
    walk.bsdf_pdf = next->pdf;
    // Not where a path goes straight on: what it finds later is weighted against lights sampled here.
    walk.from = world::lit_point(hit.point.position, closure, wo);
    if (first_after_receiver && next->delta) walk.counts = settings_.paths != Paths::columns;
    walk.after_receiver = false;
    if (!next->delta && ++walk.non_delta_vertices == 1) {
      walk.after_receiver = true;
      if (settings_.carried.bound > 0)
        walk.receiver_term = kPi * max_component(scatter::eval(closure, wo, next->wi));
    }
    if (connection > 0 && !next->delta) {
      walk.throughput *= missing(connection, closure, wo, next->wi);
      if (is_black(walk.throughput)) return false;
    }
    if (!survives(walk)) return false;
  }
  if (pass && first_of_departed) walk.counts = false;
  walk.medium = world_.medium_beyond(hit, next->wi, walk.medium);
  walk.ray = {world::World::offset_origin(hit.point.position, hit.point.ng, next->wi), next->wi};
  return true;
}

float PathTracer::light_paths_at(const Walk& walk, const world::SurfaceHit& hit, const Closure& closure,
                                 const scatter::BsdfSample& next, float merge_area) const {
  if (walk.from_eye) return beside_->ratio_on(walk.ray, walk.traveled, hit, closure, next.wi, next.pdf);
  return merge_area > 0 ? beside_->ratio_merged(merge_area, hit, closure, next.wi, next.pdf) : 0.0f;
}

}  // namespace lumirank::pathtrace
