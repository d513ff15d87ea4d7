#include "transport/lights/emitter_lights.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "base/hash_text.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/sequence.h"
#include "transport/lights/halves.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kDiscSamples = 16;

// What the k-th of n samples of an emitter gets in random numbers.
struct SampleNumbers {
  float u1;
  Vec2f u2;
  std::uint64_t id;  // of the light
};

// No light leaves farther from the axis than where the table ends; rounding must not cut the edge off.
SpotShape profile_shape(const emitters::ProfileEmitter& e) {
  SpotShape shape;
  shape.cutoff = std::min(kPi, e.profile->max_theta() + 1e-3f);
  shape.cos_cutoff = shape.cutoff < kPi ? std::cos(shape.cutoff) : -2.0f;
  shape.profile = e.profile;
  shape.frame = e.frame;
  return shape;
}

// One sample of one emitter as a light. `share`: 1 over the number of samples that stand for the emitter, all
// of them chosen at random unless `half` is kNoHalf.
class SampleMaker {
 public:
  SampleMaker(const world::World& world, int emitter, SampleNumbers numbers, double share, std::uint8_t half)
      : world_(world), emitter_(emitter), u_(numbers), share_(share), half_(half) {}

  // False if no light leaves there.
  bool make(LightBatch& batch) {
    light_ = {};
    light_.emitter = static_cast<std::uint16_t>(emitter_);
    light_.half = half_;
    light_.id = u_.id;
    std::visit([&](const auto& kind) { fill(kind, batch); },
               world_.emitters()[static_cast<std::size_t>(emitter_)].kind);
    if (!(max_component(light_.power) > 0)) return false;
    light_.ng = light_.normal;
    batch.lights.push_back(light_);
    return true;
  }

 private:
  float share() const { return static_cast<float>(share_); }

  // Cosine emission from an area: the particle's weight is π·Le over the density per area.
  void fill(const emitters::AreaEmitter& e, LightBatch&) {
    const auto s = world_.sample_emission(emitter_, u_.u1, u_.u2, {0.5f, 0.5f});
    if (!(max_component(s.weight) > 0)) return;
    light_.kind = LightKind::oriented;
    light_.position = s.origin;
    light_.normal = s.normal;
    light_.power = s.weight * (kInvPi * share());
    const float pmf = e.by_power.pmf(s.triangle);
    light_.area = e.triangles[s.triangle].area / pmf * share();
  }
  void fill(const emitters::PointEmitter& e, LightBatch&) {
    light_.kind = LightKind::omni;
    light_.position = e.position;
    light_.power = e.intensity * share();
  }
  void fill(const emitters::SpotEmitter& e, LightBatch& batch) {
    light_.kind = LightKind::spot;
    light_.position = e.position;
    light_.normal = e.frame.n;
    light_.power = e.intensity * share();
    light_.closure = static_cast<std::uint32_t>(batch.spots.size());
    batch.spots.push_back({e.cos_cutoff, e.cos_beam, e.cutoff, e.beam, nullptr, {}});
  }
  void fill(const emitters::ProfileEmitter& e, LightBatch& batch) {
    light_.kind = LightKind::spot;
    light_.position = e.position;
    light_.normal = e.frame.n;
    light_.power = e.scale * share();
    light_.closure = static_cast<std::uint32_t>(batch.spots.size());
    batch.spots.push_back(profile_shape(e));
  }
  void fill(const emitters::DirectionalEmitter&, LightBatch&) { fill_far(); }
  void fill(const emitters::EnvironmentEmitter&, LightBatch&) { fill_far(); }
  // Far light enters by the disc that covers the scene: the particle's weight is the irradiance times that
  // disc's area.
  void fill_far() {
    const auto s = world_.sample_emission(emitter_, u_.u1, {0.5f, 0.5f}, u_.u2);
    if (!(max_component(s.weight) > 0)) return;
    const float radius = world_.bounds().radius();
    light_.kind = LightKind::directional;
    light_.normal = s.direction;
    light_.position = world_.bounds().center() - s.direction * radius;
    light_.power = s.weight * (share() / (kPi * square(radius)));
  }

  const world::World& world_;
  int emitter_;
  SampleNumbers u_;
  double share_;
  std::uint8_t half_;
  LightRecord light_;
};

// 0: as many as one likes.
std::size_t fixed_count(const emitters::Emitter& e) {
  if (std::holds_alternative<emitters::AreaEmitter>(e.kind) ||
      std::holds_alternative<emitters::EnvironmentEmitter>(e.kind))
    return 0;
  if (const auto* sun = std::get_if<emitters::DirectionalEmitter>(&e.kind); sun && sun->cos_half_angle < 1)
    return kDiscSamples;
  return 1;
}

// Evenly spread numbers for `n` samples, each half by itself.
class HalvedNumbers {
 public:
  HalvedNumbers(std::uint64_t seed, std::uint64_t id, std::size_t n)
      : seed_(seed), id_(id), n_(n), sequences_{sequence(0), sequence(1)} {}

  // In the k-th of n equal parts of [0, 1), as the half sees them.
  double stratified(std::size_t k) const {
    const PlaceInHalf place(k, n_);
    Rng rng(seed_, Stage::emitter_samples, id_, k);
    return (static_cast<double>(place.index) + rng.next_double()) / static_cast<double>(place.size);
  }
  std::uint64_t light_id(std::size_t k) const { return hash_ids(id_, Stage::emitter_samples, k); }
  Vec2f point(std::size_t k) const {
    const PlaceInHalf place(k, n_);
    return sequences_[place.half](place.index);
  }

 private:
  Sequence2 sequence(std::size_t half) const {
    return {seed_, Stage::emitter_samples, PlaceInHalf(half, n_).key(id_)};
  }

  std::uint64_t seed_, id_;
  std::size_t n_;
  Sequence2 sequences_[2];
};

void samples_of(const world::World& world, int emitter, std::uint64_t seed, std::uint64_t key, std::size_t n,
                LightBatch& batch) {
  const HalvedNumbers numbers(seed, key, n);
  for (std::size_t i = 0; i < n; ++i) {
    const SampleNumbers u{std::min(static_cast<float>(numbers.stratified(i)), 0x1.fffffep-1f),
                          numbers.point(i), numbers.light_id(i)};
    SampleMaker(world, emitter, u, 1 / static_cast<double>(n), n == 1 ? kNoHalf : PlaceInHalf(i, n).feature())
        .make(batch);
  }
}

// As many in one half as in the other.
std::size_t samples_for(double wanted) {
  return 2 * std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(0.5 * wanted)));
}

void every_emitter(const world::World& world, const world::EmitterChoice& choice, std::uint64_t seed,
                   std::size_t count, LightBatch& batch) {
  double sampled = 0;
  std::size_t fixed = 0;
  std::vector<std::size_t> counts(choice.size());
  for (std::size_t k = 0; k < choice.size(); ++k) {
    counts[k] = fixed_count(world.emitters()[static_cast<std::size_t>(choice.emitter(k))]);
    fixed += counts[k];
    if (counts[k] == 0) sampled += choice.probability(k);
  }
  const double rest = count > fixed ? static_cast<double>(count - fixed) : 0.0;
  for (std::size_t k = 0; k < choice.size(); ++k) {
    const int emitter = choice.emitter(k);
    const std::size_t n = counts[k] > 0 ? counts[k] : samples_for(rest * choice.probability(k) / sampled);
    samples_of(world, emitter, seed, static_cast<std::uint64_t>(emitter), n, batch);
  }
}

void some_emitters(const world::World& world, const world::EmitterChoice& choice, std::uint64_t seed,
                   std::size_t count, LightBatch& batch) {
  constexpr std::uint64_t kAll = ~0ull;  // no emitter has this id
  count = even(count);
  const HalvedNumbers numbers(seed, kAll, count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto drawn = choice.draw(numbers.stratified(i));
    const double share = 1 / (drawn.probability * static_cast<double>(count));
    SampleMaker(world, drawn.emitter, {drawn.remapped, numbers.point(i), numbers.light_id(i)}, share,
                PlaceInHalf(i, count).feature())
        .make(batch);
  }
}

}  // namespace

DirectNeed direct_need(const world::World& world, const world::EmitterChoice& choice) {
  DirectNeed need;
  for (std::size_t k = 0; k < choice.size(); ++k) {
    const std::size_t n = fixed_count(world.emitters()[static_cast<std::size_t>(choice.emitter(k))]);
    need.min_count += std::max<std::size_t>(n, 1);
    need.sampled = need.sampled || n == 0;
  }
  return need;
}

LightBatch emitter_lights(const world::World& world, const world::EmitterChoice& choice, std::uint64_t seed,
                          std::size_t count) {
  LightBatch batch;
  if (choice.empty() || count == 0) return batch;
  const DirectNeed need = direct_need(world, choice);
  if (need.min_count <= count && (!need.sampled || 2 * need.min_count <= count || choice.size() == 1)) {
    every_emitter(world, choice, seed, count, batch);
  } else {
    some_emitters(world, choice, seed, count, batch);
  }
  return batch;
}

EmitterCounts count_emitter_lights(std::span<const world::World* const> worlds, std::size_t count) {
  struct Seen {
    std::size_t fixed = 0;
    double probability = 0;
  };
  std::map<std::string, Seen> seen;
  for (const world::World* world : worlds) {
    const world::EmitterChoice choice(*world);
    for (std::size_t k = 0; k < choice.size(); ++k) {
      const emitters::Emitter& e = world->emitters()[static_cast<std::size_t>(choice.emitter(k))];
      Seen& s = seen[e.name];
      s.fixed = fixed_count(e);
      s.probability += choice.probability(k);
    }
  }
  std::size_t fixed = 0;
  double sampled = 0;
  for (const auto& [name, s] : seen) {
    fixed += s.fixed;
    if (s.fixed == 0) sampled += s.probability;
  }
  const double rest = count > fixed ? static_cast<double>(count - fixed) : 0.0;
  EmitterCounts counts;
  for (const auto& [name, s] : seen)
    counts.of[name] = s.fixed > 0 ? s.fixed : samples_for(rest * s.probability / sampled);
  return counts;
}

LightBatch emitter_lights(const world::World& world, const EmitterCounts& counts, std::uint64_t seed) {
  LightBatch batch;
  if (counts.of.empty()) return batch;
  std::size_t fewest = 0;
  for (const auto& [name, n] : counts.of)
    if (n > kDiscSamples) fewest = fewest == 0 ? n : std::min(fewest, n);
  const world::EmitterChoice choice(world);
  for (std::size_t k = 0; k < choice.size(); ++k) {
    const int emitter = choice.emitter(k);
    const emitters::Emitter& e = world.emitters()[static_cast<std::size_t>(emitter)];
    const auto found = counts.of.find(e.name);
    std::size_t n = fixed_count(e);
    if (n == 0) n = found != counts.of.end() ? found->second : std::max<std::size_t>(kDiscSamples, fewest);
    samples_of(world, emitter, seed, hash_text(e.name), n, batch);
  }
  return batch;
}

}  // namespace lumirank::transport
