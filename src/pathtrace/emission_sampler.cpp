#include "pathtrace/emission_sampler.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "base/warp.h"

namespace lumirank::pathtrace {
namespace {

using emitters::AreaEmitter;
using emitters::DirectionalEmitter;
using emitters::EnvironmentEmitter;
using emitters::PointEmitter;
using emitters::ProfileEmitter;
using emitters::SpotEmitter;

// Of rounding, where the scene's disc ends.
constexpr float kSlack = 1 + 1e-4f;

float disc_pdf(const DirectionalEmitter& sun) { return 1 / (2 * kPi * (1 - sun.cos_half_angle)); }

// Per solid angle, for those that shine from a point.
struct PointPdf {
  Vec3f direction;  // of the light
  float operator()(const PointEmitter&) const { return 1 / (4 * kPi); }
  float operator()(const SpotEmitter& e) const {
    return dot(direction, e.frame.n) > e.cos_cutoff ? 1 / (2 * kPi * (1 - e.cos_cutoff)) : 0.0f;
  }
  float operator()(const ProfileEmitter& e) const { return e.profile->pdf(e.frame.to_local(direction)); }
  template <typename Other>
  float operator()(const Other&) const {
    return 0;
  }
};

// W/sr.
struct PointIntensity {
  Vec3f direction;
  Rgb operator()(const PointEmitter& e) const { return e.intensity; }
  Rgb operator()(const SpotEmitter& e) const { return e.intensity_towards(direction); }
  Rgb operator()(const ProfileEmitter& e) const { return e.intensity_towards(direction); }
  template <typename Other>
  Rgb operator()(const Other&) const {
    return Rgb(0);
  }
};

template <typename Kind>
bool is_far(const Kind& kind) {
  return std::holds_alternative<DirectionalEmitter>(kind) || std::holds_alternative<EnvironmentEmitter>(kind);
}

}  // namespace

EmissionSampler::EmissionSampler(const world::World& world, LightTargets targets)
    : world_(world),
      targets_(std::move(targets)),
      choice_(world),
      probabilities_(world.emitters().size()),
      disc_(kPi * square(world.bounds().radius())) {
  for (std::size_t k = 0; k < choice_.size(); ++k) {
    const auto e = static_cast<std::size_t>(choice_.emitter(k));
    probabilities_[e] = static_cast<float>(choice_.probability(k));
    const auto* sun = std::get_if<DirectionalEmitter>(&world.emitters()[e].kind);
    if (sun && sun->cos_half_angle < 1) suns_.push_back(choice_.emitter(k));
  }
}

std::optional<EmissionSampler::Start> EmissionSampler::sample(SampleStream& random) const {
  const auto choice = random.next_fine();
  const auto chosen = choice_.draw(choice.x);
  Start start;
  start.emitter = chosen.emitter;
  const Vec2f position = random.next_2d();
  const auto emission = world_.sample_emission(start.emitter, choice.y, position, random.next_2d());
  start.flux = emission.weight / static_cast<float>(chosen.probability);
  start.triangle = emission.triangle;
  start.ray = {emission.origin, emission.direction};
  const auto& kind = world_.emitters()[static_cast<std::size_t>(start.emitter)].kind;
  const bool area = std::holds_alternative<AreaEmitter>(kind);
  start.far = is_far(kind);
  if (area)
    start.ray.origin = world::World::offset_origin(emission.origin, emission.normal, emission.direction);
  const bool seen =
      area ? std::get<AreaEmitter>(kind).seen : std::holds_alternative<EnvironmentEmitter>(kind);
  start.delta = !seen;
  if (!targets_.empty()) {
    const float u = random.next_float();
    aim(start, emission, u, random.next_2d());
  }
  if (!(max_component(start.flux) > 0)) return std::nullopt;
  return start;
}

// Sends a start that the emitter chose to a target instead, by chance; its flux is that of the mixture.
void EmissionSampler::aim(Start& start, const emitters::Emission& emission, float u, Vec2f where) const {
  const auto target = targets_.draw(u);
  const auto e = static_cast<std::size_t>(start.emitter);
  const auto& kind = world_.emitters()[e].kind;
  const bool area = std::holds_alternative<AreaEmitter>(kind), dark = !(max_component(start.flux) > 0);
  // Where a point is dark in the direction that it drew, it may still shine in another.
  if (dark && (!target || area || is_far(kind))) return;
  if (is_far(kind)) {
    const Vec3f w = start.ray.direction;
    if (target) {
      const Vec3f to = targets_.place_on(*target, w, where) - world_.bounds().center();
      start.ray.origin = world_.bounds().center() + to - w * (dot(to, w) + world_.bounds().radius());
    }
    start.flux *= 1 / (disc_ * across(start.ray.origin, -w));
    return;
  }
  const Vec3f place = emission.origin, normal = area ? emission.normal : Vec3f{0, 0, 0};
  const auto to_target = target ? targets_.direction_to(*target, place, normal, where) : std::nullopt;
  if (dark && !to_target) return;
  if (to_target) start.ray.direction = *to_target;
  const Vec3f w = start.ray.direction;
  if (area) {
    const float own = pdf_cosine_hemisphere(dot(normal, w));
    start.ray.origin = world::World::offset_origin(place, normal, w);
    start.flux *= own / targets_.per_solid_angle(place, normal, w, own);
    return;
  }
  const float own = std::visit(PointPdf{w}, kind);
  start.flux = std::visit(PointIntensity{w}, kind) /
               (probabilities_[e] * targets_.per_solid_angle(place, normal, w, own));
}

float EmissionSampler::across(Vec3f place, Vec3f direction) const {
  // All surfaces are within the disc; a medium may reach beyond it, and beyond where light starts.
  const bool media = !world_.media().empty();
  if (media && dot(place - world_.bounds().center(), direction) > kSlack * world_.bounds().radius()) return 0;
  const float own = !media || passes_scene(place, direction) ? 1 / disc_ : 0.0f;
  return targets_.empty() ? own : targets_.per_area(place, direction, own);
}

bool EmissionSampler::passes_scene(Vec3f place, Vec3f direction) const {
  const Vec3f to = place - world_.bounds().center();
  return length_squared(to - direction * dot(to, direction)) <= square(kSlack * world_.bounds().radius());
}

float EmissionSampler::density(int emitter, std::uint32_t triangle, Vec3f place, Vec3f direction) const {
  const auto e = static_cast<std::size_t>(emitter);
  const auto& kind = world_.emitters()[e].kind;
  if (const auto* area = std::get_if<AreaEmitter>(&kind)) {
    if (triangle >= area->triangles.size() || !area->seen) return 0;
    const auto& t = area->triangles[triangle];
    if (!(t.area > 0)) return 0;
    float leaving = kInvPi;  // per projected solid angle
    const float cosine = -dot(t.normal, direction);
    if (!targets_.empty() && cosine > 0)
      leaving = targets_.per_solid_angle(place, t.normal, -direction, cosine * kInvPi) / cosine;
    return probabilities_[e] * area->by_power.pmf(triangle) / t.area * leaving;
  }
  if (const auto* environment = std::get_if<EnvironmentEmitter>(&kind))
    return probabilities_[e] * environment->pdf(direction) * across(place, direction);
  if (const auto* sun = std::get_if<DirectionalEmitter>(&kind))
    return sun->cos_half_angle < 1 ? probabilities_[e] * disc_pdf(*sun) * across(place, direction) : 0.0f;
  return 0;
}

float EmissionSampler::delta_density(int emitter, Vec3f place, Vec3f direction, float distance) const {
  const auto e = static_cast<std::size_t>(emitter);
  const auto& kind = world_.emitters()[e].kind;
  if (std::holds_alternative<DirectionalEmitter>(kind)) return probabilities_[e] * across(place, direction);
  float leaving = std::visit(PointPdf{-direction}, kind);
  if (!targets_.empty())
    leaving = targets_.per_solid_angle(place + direction * distance, {0, 0, 0}, -direction, leaving);
  return probabilities_[e] * leaving / square(distance);
}

Rgb EmissionSampler::background_left(const geometry::Ray& ray, float ratio) const {
  Rgb sum{0};
  const Vec3f w = ray.direction;
  if (const int e = world_.environment(); e >= 0)
    sum += world_.background(w) / (1 + ratio * density(e, 0, ray.origin, w));
  for (const int e : suns_) {
    const auto& kind = world_.emitters()[static_cast<std::size_t>(e)].kind;
    sum += std::get<DirectionalEmitter>(kind).radiance_from(w) / (1 + ratio * density(e, 0, ray.origin, w));
  }
  return sum;
}

}  // namespace lumirank::pathtrace
