#include "pathtrace/emission_sampler.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace lumirank::pathtrace {
namespace {

using emitters::AreaEmitter;
using emitters::DirectionalEmitter;
using emitters::EnvironmentEmitter;
using emitters::PointEmitter;
using emitters::ProfileEmitter;
using emitters::SpotEmitter;

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

}  // namespace

EmissionSampler::EmissionSampler(const world::World& world)
    : world_(world),
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
  if (!(max_component(start.flux) > 0)) return std::nullopt;
  start.triangle = emission.triangle;
  start.ray = {emission.origin, emission.direction};
  const auto& kind = world_.emitters()[static_cast<std::size_t>(start.emitter)].kind;
  if (std::holds_alternative<AreaEmitter>(kind))
    start.ray.origin = world::World::offset_origin(emission.origin, emission.normal, emission.direction);
  start.delta =
      !std::holds_alternative<AreaEmitter>(kind) && !std::holds_alternative<EnvironmentEmitter>(kind);
  return start;
}

float EmissionSampler::density(int emitter, std::uint32_t triangle, Vec3f direction) const {
  const auto e = static_cast<std::size_t>(emitter);
  const auto& kind = world_.emitters()[e].kind;
  if (const auto* area = std::get_if<AreaEmitter>(&kind)) {
    if (triangle >= area->triangles.size()) return 0;
    const float size = area->triangles[triangle].area;
    return size > 0 ? probabilities_[e] * area->by_power.pmf(triangle) / (size * kPi) : 0.0f;
  }
  if (const auto* environment = std::get_if<EnvironmentEmitter>(&kind))
    return probabilities_[e] * environment->pdf(direction) / disc_;
  if (const auto* sun = std::get_if<DirectionalEmitter>(&kind))
    return sun->cos_half_angle < 1 ? probabilities_[e] * disc_pdf(*sun) / disc_ : 0.0f;
  return 0;
}

float EmissionSampler::delta_density(int emitter, Vec3f direction, float distance) const {
  const auto e = static_cast<std::size_t>(emitter);
  const auto& kind = world_.emitters()[e].kind;
  if (std::holds_alternative<DirectionalEmitter>(kind)) return probabilities_[e] / disc_;
  return probabilities_[e] * std::visit(PointPdf{-direction}, kind) / square(distance);
}

Rgb EmissionSampler::background_left(Vec3f direction, float ratio) const {
  Rgb sum{0};
  if (const int e = world_.environment(); e >= 0)
    sum += world_.background(direction) / (1 + ratio * density(e, 0, direction));
  for (const int e : suns_) {
    const auto& kind = world_.emitters()[static_cast<std::size_t>(e)].kind;
    sum +=
        std::get<DirectionalEmitter>(kind).radiance_from(direction) / (1 + ratio * density(e, 0, direction));
  }
  return sum;
}

}  // namespace lumirank::pathtrace
