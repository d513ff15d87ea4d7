#include "transport/lights/gather_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <unordered_map>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/sequence.h"
#include "scatter/closure.h"
#include "transport/lights/halves.h"
#include "transport/lights/particle.h"
#include "world/light_sampler.h"
#include "world/surface.h"

namespace lumirank::transport {
namespace {

using scatter::Closure;

constexpr std::size_t kSamplesAtOnce = 256, kPhotonsAtOnce = 1024;
// Shadow rays of each sample; it is one of very many lights.
constexpr std::uint64_t kDirectRays = 8;
// Samples that share a photon, and how many of the nearest are asked for to find as many on its side of the
// surface; at last on any shape.
constexpr std::size_t kSharers = 4;
struct Asking {
  std::size_t nearest;
  bool enough_with_fewer;  // sharers than kSharers
  bool same_shape, seen;
};
constexpr Asking kAskings[] = {
    {8, false, true, true}, {32, true, true, true}, {512, true, true, true}, {512, true, false, false}};
constexpr std::size_t kMostAsked = 512;
constexpr float kSameSide = 0.5f;  // cosine between normals
// Photon and sample see each other from so far above the surface, of their distance: a sample on the floor
// beneath a cupboard takes nothing of the light beside it, where it would be lost.
constexpr float kLift = 0.1f;
constexpr double kPhotonsPerSample = 8;
constexpr std::size_t kMinPhotons = 100'000;
// For counting the lights that a sample leaves.
constexpr std::size_t kPilotSamples = 4096;
constexpr double kMaxSamplesPerLight = 4;

// Where so much of what a surface sends on leaves in lobes narrower than this, light is kept apart by the
// octant of space that it came from.
constexpr float kNarrow = 0.5f, kMostlyNarrow = 0.3f;
constexpr std::size_t kOctants = 8;

std::size_t octant(Vec3f d) { return (d.x < 0 ? 1u : 0u) | (d.y < 0 ? 2u : 0u) | (d.z < 0 ? 4u : 0u); }

// Light that arrives at one side of a sample, in parts: all of it, its mean direction, and one of the parts
// drawn by power. The draw goes by each part's own random number, so that a part that stays the same has the
// same chance at every moment.
struct Arriving {
  Rgb flux;
  Vec3f direction;     // of the drawn part, back towards where it came from
  Vec3f directions{};  // of all parts, times their power
  int emitter = 0, depth = 1;
  double race = kInfinity;

  void add(const Rgb& part, Vec3f from, int emitter_, int depth_, std::uint64_t number) {
    const double power = max_component(part);
    if (!(power > 0)) return;
    flux += part;
    directions += from * static_cast<float>(power);
    const double time = -std::log1p(-unit_double(mix64(number))) / power;
    if (time < race) race = time, direction = from, emitter = emitter_, depth = depth_;
  }
};

// A sample at one moment.
struct PlacedSample {
  bool there = false;
  bool fiber = false;
  geometry::Hit hit;
  Vec3f position, ng, n;  // of the front; zero on a fiber
  Vec3f along;            // of a fiber
  float area = 0;
  bool shines[2] = {false, false};  // light that arrives in front, behind, is sent on
  std::size_t octants = 1;          // that its light is kept apart by
  std::size_t first = 0;            // of what arrives there: by cause, side and octant
};

enum Cause : std::size_t { direct_light = 0, photon_light = 1 };

class GatherLighting {
 public:
  GatherLighting(const world::World& world, const GatherSamples& samples, const LightSurvey& survey,
                 const LightSettings& settings)
      : world_(world), samples_(samples), survey_(survey), settings_(settings) {
    place();
    std::size_t parts = 0;
    for (PlacedSample& at : placed_) at.first = parts, parts += 4 * at.octants;
    light_.resize(parts);
  }

  void add_direct() {
    const world::LightSampler& lights = world_.light_sampler();
    parallel_for(placed_.size(), kSamplesAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        if (placed_[k].there) add_direct(lights, k);
    });
  }

  void add_photons(std::size_t count) {
    if (count == 0 || (survey_.parts.deepest >= 0 && survey_.parts.deepest < 2)) return;
    std::vector<LightBatch> pieces((count + kPhotonsAtOnce - 1) / kPhotonsAtOnce);
    const world::EmitterChoice choice(world_);
    const ParticleTracer tracer(world_, choice,
                                {settings_.seed,
                                 Stage::gather_samples,
                                 count,
                                 survey_.parts.deepest,
                                 0,
                                 &survey_.aim.guide,
                                 {},
                                 nullptr});
    parallel_for(count, kPhotonsAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t path = begin; path < end; ++path) tracer.trace(path, pieces[begin / kPhotonsAtOnce]);
    });
    std::vector<LightRecord> photons;
    for (const LightBatch& piece : pieces)
      for (const LightRecord& p : piece.lights)
        if (p.depth >= 2) photons.push_back(p);  // the emitters' own light is direct
    share_out(photons);
  }

  std::vector<LightBatch> lights() const {
    std::vector<LightBatch> batches((placed_.size() + kSamplesAtOnce - 1) / kSamplesAtOnce);
    parallel_for(placed_.size(), kSamplesAtOnce, [&](std::size_t begin, std::size_t end) {
      LightBatch& batch = batches[begin / kSamplesAtOnce];
      for (std::size_t k = begin; k < end; ++k)
        for (std::size_t part = 0; part < 4 * placed_[k].octants; ++part) leave(k, part, batch);
      batch.lights.shrink_to_fit();
      batch.closures.shrink();
    });
    return batches;
  }

 private:
  void place() {
    const auto& ids = world_.placement_ids();
    std::unordered_map<std::uint64_t, std::uint32_t> known;
    for (std::uint32_t i = 0; i < ids.size(); ++i) known.emplace(ids[i], i);
    std::vector<int> placement(samples_.shapes.size(), -1);
    for (std::size_t s = 0; s < placement.size(); ++s) {
      const auto found = known.find(samples_.shapes[s].id);
      if (found == known.end()) continue;
      const auto mesh = world_.rays().placements()[found->second].mesh;
      if (world_.rays().mesh(mesh).primitive_count() == samples_.shapes[s].primitives)
        placement[s] = static_cast<int>(found->second);
    }
    placed_.resize(samples_.samples.size());
    parallel_for(placed_.size(), kSamplesAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        if (placement[samples_.samples[k].shape] >= 0)
          place(k, static_cast<std::uint32_t>(placement[samples_.samples[k].shape]));
    });
  }

  void place(std::size_t k, std::uint32_t instance) {
    const GatherSample& sample = samples_.samples[k];
    PlacedSample& at = placed_[k];
    const std::uint32_t mesh = world_.rays().placements()[instance].mesh;
    at.area = sample.part * static_cast<float>(world::primitive_area(world_, instance, sample.primitive));
    if (!(at.area > 0)) return;
    at.fiber = !world_.rays().mesh(mesh).fibers.empty();
    at.hit = {0, instance, mesh, sample.primitive,
              at.fiber ? Vec2f{sample.at.x, 2 * sample.at.y - 1} : sample.at};
    const world::SurfaceHit hit = world_.surface(at.hit, {0, 0, 1});
    at.position = hit.point.position;
    at.there = true;
    if (at.fiber) {
      at.along = hit.point.dpdu;
      at.shines[0] = true;
      return;
    }
    at.ng = hit.point.ng;
    for (std::size_t side = 0; side < 2; ++side) {
      const Closure closure = world_.materials().closure(hit.material, hit.point, side == 0 ? at.ng : -at.ng);
      at.shines[side] = closure.has_non_delta();
      if (is_mostly_narrow(closure, side == 0 ? at.ng : -at.ng)) at.octants = kOctants;
      if (side == 0 || at.n == Vec3f{}) at.n = closure.frame.n;
    }
    if (dot(at.n, at.ng) < 0) at.n = -at.n;
    at.there = at.shines[0] || at.shines[1];
  }

  bool is_mostly_narrow(const Closure& closure, Vec3f wo) const {
    if (settings_.lobes.diffuse_only) return false;
    const Closure narrow = scatter::sharp_part(closure, kNarrow);
    return narrow.count > 0 && max_component(scatter::albedo(narrow, wo)) >
                                   kMostlyNarrow * max_component(scatter::albedo(closure, wo));
  }

  Arriving& arriving(std::size_t k, Cause cause, std::size_t side, Vec3f from) {
    const PlacedSample& at = placed_[k];
    return light_[at.first + (2 * cause + side) * at.octants + (at.octants > 1 ? octant(from) : 0)];
  }

  void add_direct(const world::LightSampler& lights, std::size_t k) {
    const GatherSample& sample = samples_.samples[k];
    const PlacedSample& at = placed_[k];
    const bool both = at.fiber || (at.shines[0] && at.shines[1]);
    const emitters::LitPoint lit{at.position, at.fiber ? Vec3f{} : (at.shines[0] ? at.n : -at.n), both};
    const Sequence2 spread(settings_.seed, Stage::gather_samples, sample.id);
    const double shift = unit_double(hash_ids(sample.id, Stage::gather_samples, 3));
    for (std::uint64_t r = 0; r < kDirectRays; ++r) {
      const auto s =
          lights.sample(lit, (static_cast<double>(r) + shift) / static_cast<double>(kDirectRays), spread(r));
      if (!(s.pdf > 0) || !(max_component(s.direct.radiance) > 0)) continue;
      const Vec3f wi = s.direct.direction;
      // As an incident flux goes through the geometric surface and the closure's cosine is that of the
      // shading normal, this is Veach's correction (1997, section 5.3) as in particle.cpp.
      const float cosine =
          at.fiber ? std::sqrt(std::max(0.0f, 1 - square(dot(wi, at.along)))) : std::abs(dot(wi, at.n));
      const std::size_t side = at.fiber || dot(wi, at.ng) > 0 ? 0 : 1;
      if (!at.shines[side] || (!at.fiber && (dot(wi, at.n) > 0) != (side == 0))) continue;
      const std::uint64_t number = hash_ids(sample.id, Stage::gather_samples, 4, r);
      const Rgb visible = world::visible_fraction(world_, at.position, at.ng, wi, s.direct.distance, number);
      arriving(k, direct_light, side, wi)
          .add(s.direct.radiance * visible * (cosine * at.area / (s.pdf * static_cast<float>(kDirectRays))),
               wi, s.emitter, 1, number);
    }
  }

  // What nanoflann wants to know of the samples that are there.
  struct Places {
    std::vector<Vec3f> points;
    std::vector<std::uint32_t> sample;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<int>(axis)]; }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using PlaceTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Places>, Places,
                                                        3, std::uint32_t>;

  struct Share {
    std::uint32_t sample = 0;
    std::uint8_t side = 0;
    float part = 0;
  };
  using Shares = std::array<Share, kSharers>;

  static bool takes(const PlacedSample& at, const LightRecord& photon, bool same_shape, std::size_t& side) {
    const bool fiber = photon.ng == Vec3f{};
    side = 0;
    if (at.fiber != fiber || (same_shape && at.hit.instance != photon.placement)) return false;
    if (fiber) return true;
    // Not the other face of a thin wall: outsides agree, and then sides.
    const Vec3f outside = photon.behind ? -photon.ng : photon.ng;
    side = photon.behind ? 1 : 0;
    return dot(outside, at.ng) > kSameSide && at.shines[side];
  }

  // Nothing stands between, seen from a little above the surface.
  bool open_between(const LightRecord& photon, const PlacedSample& at) const {
    if (at.fiber) return true;
    const float lift = kLift * std::sqrt(length_squared(at.position - photon.position));
    const Vec3f from = photon.position + photon.ng * lift;
    const Vec3f to = at.position + (photon.behind ? -at.ng : at.ng) * lift;
    geometry::Ray ray;
    ray.origin = from, ray.direction = to - from, ray.t_min = 0, ray.t_max = 1;
    return !world_.rays().occluded(ray, photon.id);
  }

  // The nearest on its shape and side, those of other shapes if there are none of it; less the farther they
  // are.
  Shares sharers(const Places& places, const PlaceTree& tree, const LightRecord& photon) const {
    Shares shares;
    std::size_t taken = 0;
    float last = 0;
    for (const Asking& asking : kAskings) {
      std::array<std::uint32_t, kMostAsked> near;
      std::array<float, kMostAsked> squared;
      const float from[3] = {photon.position.x, photon.position.y, photon.position.z};
      const std::size_t found = tree.knnSearch(from, asking.nearest, near.data(), squared.data());
      taken = 0;
      for (std::size_t i = 0; i < found && taken < kSharers; ++i) {
        std::size_t side;
        const std::uint32_t k = places.sample[near[i]];
        if (!takes(placed_[k], photon, asking.same_shape, side)) continue;
        if (asking.seen && !open_between(photon, placed_[k])) continue;
        shares[taken++] = {k, static_cast<std::uint8_t>(side), squared[i]};
        last = squared[i];
      }
      if (taken == kSharers || (taken > 0 && asking.enough_with_fewer)) break;
    }
    // The farthest one gets little, so that shares change smoothly when the order does.
    for (std::size_t i = 0; i < taken; ++i)
      shares[i].part = last > 0 ? std::max(0.02f, square(1 - shares[i].part / last)) : 1.0f;
    float all = 0;
    for (const Share& s : shares) all += s.part;
    for (Share& s : shares) s.part = all > 0 ? s.part / all : 0.0f;
    return shares;
  }

  void share_out(const std::vector<LightRecord>& photons) {
    Places places;
    for (std::uint32_t k = 0; k < placed_.size(); ++k)
      if (placed_[k].there) places.points.push_back(placed_[k].position), places.sample.push_back(k);
    if (places.points.empty() || photons.empty()) return;
    const PlaceTree tree(3, places, {16});
    std::vector<Shares> shares(photons.size());
    parallel_for(photons.size(), kPhotonsAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) shares[p] = sharers(places, tree, photons[p]);
    });
    // In the order of the photons, so that sums are the same on any number of threads.
    for (std::size_t p = 0; p < photons.size(); ++p)
      for (const Share& s : shares[p])
        if (s.part > 0)
          arriving(s.sample, photon_light, s.side, photons[p].incoming)
              .add(photons[p].power * s.part, photons[p].incoming, photons[p].emitter, photons[p].depth,
                   photons[p].id ^ samples_.samples[s.sample].id);
  }

  // As a light, if the surface sends any of it on.
  void leave(std::size_t k, std::size_t part, LightBatch& batch) const {
    const PlacedSample& at = placed_[k];
    const Arriving& arriving = light_[at.first + part];
    if (!(max_component(arriving.flux) > 0) || !is_finite(arriving.flux)) return;
    // A drawn direction is another one whenever its part is gone. Where lobes are widened anyhow, the mean of
    // an octant says as much and moves evenly.
    const bool mean = at.octants > 1 && settings_.lobes.least_roughness > 0;
    const Vec3f incoming = mean ? normalize(arriving.directions) : arriving.direction;
    const world::SurfaceHit hit = world_.surface(at.hit, -incoming);
    const Closure whole = world_.materials().closure(hit.material, hit.point, incoming);
    const Closure closure = settings_.lobes.of(whole, incoming);
    if (!closure.has_non_delta() || !closure.sides_agree(incoming)) return;
    LightRecord light;
    light.kind = LightKind::surface;
    light.position = hit.point.position;
    light.incoming = incoming;
    const float sign = dot(closure.frame.n, incoming) < 0 ? -1.0f : 1.0f;
    light.normal = closure.frame.n * sign;
    light.ng = closure.ng * sign;
    light.power = arriving.flux;
    light.area = at.area;
    light.emitter = static_cast<std::uint16_t>(arriving.emitter);
    light.depth = static_cast<std::uint16_t>(arriving.depth);
    light.path = static_cast<std::uint32_t>(k);
    light.half = PlaceInHalf(k, placed_.size()).feature();
    light.id = hash_ids(samples_.samples[k].id, Stage::gather_samples, at.octants, part);
    if (closure.is_lambertian())
      light.albedo = closure.diffuse_color();
    else
      light.closure = batch.closures.add(closure, light.normal);
    batch.lights.push_back(light);
  }

  const world::World& world_;
  const GatherSamples& samples_;
  const LightSurvey& survey_;
  const LightSettings& settings_;
  std::vector<PlacedSample> placed_;
  std::vector<Arriving> light_;  // PlacedSample::first
};

std::size_t photons_for(std::size_t samples) {
  return std::max(kMinPhotons, static_cast<std::size_t>(kPhotonsPerSample * static_cast<double>(samples)));
}

}  // namespace

std::vector<LightBatch> gather_lights(const world::World& world, const GatherPlan& plan,
                                      const LightSurvey& survey, const LightSettings& settings) {
  GatherLighting lighting(world, plan.samples, survey, settings);
  lighting.add_direct();
  lighting.add_photons(plan.photons);
  return lighting.lights();
}

GatherPlan plan_gather(std::span<const world::World* const> worlds,
                       std::span<const LightSurvey* const> surveys, const LightSettings& settings) {
  if (worlds.empty() || worlds.size() != surveys.size())
    throw InternalError("gather samples need a survey of every world");
  const std::size_t middle = worlds.size() / 2;
  const LightSurvey& survey = *surveys[middle];
  GatherPlan plan;
  const std::size_t emitter_samples = emitter_sample_count(settings.count, survey);
  if (emitter_samples > 0) plan.emitters = count_emitter_lights(worlds, emitter_samples);
  if (!survey.parts.indirect) return plan;
  std::vector<GatherMoment> moments;
  for (std::size_t m = 0; m < worlds.size(); ++m)
    moments.push_back({worlds[m], surveys[m]->aim.importance.even() ? nullptr : &surveys[m]->aim.importance});
  const std::size_t wanted = settings.count > emitter_samples ? settings.count - emitter_samples : 1;
  // How many lights a sample leaves.
  const GatherSamples pilot = place_gather_samples(moments, settings.seed, std::min(wanted, kPilotSamples));
  double lights = 0;
  {
    GatherLighting lighting(*worlds[middle], pilot, survey, settings);
    lighting.add_direct();
    lighting.add_photons(photons_for(pilot.samples.size()));
    for (const LightBatch& batch : lighting.lights()) lights += static_cast<double>(batch.lights.size());
  }
  const double per_sample = pilot.samples.empty() ? 1.0 : lights / static_cast<double>(pilot.samples.size());
  const auto count = static_cast<std::size_t>(std::max(
      1.0, std::min(kMaxSamplesPerLight, 1 / std::max(per_sample, 1e-3)) * static_cast<double>(wanted)));
  plan.samples = place_gather_samples(moments, settings.seed, count);
  plan.photons = photons_for(plan.samples.samples.size());
  return plan;
}

}  // namespace lumirank::transport
