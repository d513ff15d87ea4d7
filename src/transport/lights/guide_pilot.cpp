#include "transport/lights/guide_pilot.h"

#include <algorithm>

#include "base/bounds.h"
#include "base/parallel.h"
#include "transport/lights/particle.h"
#include "transport/lights/receiver_pilot.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kPathsPerRound = 1 << 14;
constexpr int kRounds = 3;
constexpr int kPartners = 2;       // receivers asked about every light
constexpr float kNearest = 0.05f;  // nearer ones count as if this part of the receivers' extent away
constexpr std::uint64_t kPlaces = (1ull << 60) + 1;  // of random numbers; no path has it

class Relevance {
 public:
  Relevance(const world::World& world, const Receivers& receivers) : world_(world), receivers_(receivers) {
    Bounds3f box;
    for (const Vec3f p : receivers.position) box.extend(p);
    nearest2_ = square(kNearest * 2 * box.radius());
  }

  // What some receivers get of light that leaves a place, in the mean; visibility included.
  float of(const LightImportance::Site& place, Vec3f ng, Rng& rng) const {
    float sum = 0;
    for (int k = 0; k < kPartners; ++k) {
      const std::size_t i = rng.next_below(receivers_.size());
      const std::uint64_t opacity = rng.next_bits();
      const Vec3f to_place = place.position - receivers_.position[i];
      const float d2 = length_squared(to_place);
      if (!(d2 > 0)) continue;
      const Vec3f w = to_place / std::sqrt(d2);
      const float cosines = cosine(receivers_.normal[i], receivers_.ng[i], w) * cosine(place.normal, ng, -w);
      if (!(cosines > 0)) continue;
      const Vec3f from = world::World::offset_origin(receivers_.position[i], receivers_.ng[i], w);
      const Vec3f to = world::World::offset_origin(place.position, ng, -w);
      if (world_.rays().occluded({from, to - from, 0, 1 - 1e-4f}, opacity)) continue;
      sum += cosines / std::max(d2, nearest2_) * max_component(receivers_.weight[i]);
    }
    return sum / kPartners;
  }

 private:
  // A fiber (without a geometric normal) is met from everywhere, and π/4 is the mean of its sine.
  static float cosine(Vec3f n, Vec3f ng, Vec3f w) {
    return ng == Vec3f{} ? kPi / 4 : std::max(0.0f, dot(n, w));
  }

  const world::World& world_;
  const Receivers& receivers_;
  float nearest2_;
};

// What a round of paths from the emitters finds.
struct Round {
  std::vector<EmissionGuide::Observation> seen;
  std::vector<LightImportance::Site> places;
  double indirect = 0;  // as Aim::indirect
};

Round run_round(const world::World& world, const world::EmitterChoice& choice,
                const ParticleSettings& settings, const Relevance& relevance) {
  constexpr std::size_t kPathsAtOnce = 256;
  const ParticleTracer tracer(world, choice, settings);
  std::vector<Round> pieces((settings.paths + kPathsAtOnce - 1) / kPathsAtOnce);
  parallel_for(settings.paths, kPathsAtOnce, [&](std::size_t begin, std::size_t end) {
    Round& piece = pieces[begin / kPathsAtOnce];
    LightBatch batch;
    for (std::size_t path = begin; path < end; ++path) {
      batch.lights.clear(), batch.closures = {};
      const EmissionGuide::Start start = tracer.trace(path, batch);
      Rng rng(settings.seed, Stage::pilot, settings.first_id + path, 1);
      EmissionGuide::Observation o;
      o.at[0] = std::min(static_cast<float>(start.emitter), 0x1.fffffep-1f);
      std::copy(std::begin(start.rest), std::end(start.rest), o.at.begin() + 1);
      o.density = static_cast<float>(start.density);
      for (const LightRecord& light : batch.lights) {
        LightImportance::Site place{light.position, light.normal, 0, false};
        place.value = relevance.of(place, light.ng, rng);
        piece.places.push_back(place);
        o.value += place.value * rough_reflectance(light) * max_component(light.power);
      }
      piece.seen.push_back(o);
      piece.indirect += o.value * kInvPi;
    }
  });
  Round all;
  for (const Round& piece : pieces) {
    all.seen.insert(all.seen.end(), piece.seen.begin(), piece.seen.end());
    all.places.insert(all.places.end(), piece.places.begin(), piece.places.end());
    all.indirect += piece.indirect;
  }
  return all;
}

}  // namespace

Aim learn_aim(const world::World& world, const world::EmitterChoice& choice, const LightSettings& asked,
              int deepest) {
  const Receivers& receivers = *asked.receivers;
  Aim aim;
  if (receivers.size() == 0 || choice.empty()) return aim;
  const Relevance relevance(world, receivers);
  ReceiverPilot from_receivers =
      run_receiver_pilot(world, choice, receivers, asked.seed, asked.traced_direct_below);
  aim.direct = from_receivers.direct;
  aim.guide = EmissionGuide::fit(from_receivers.starts, EmissionGuide::Spread::by_importance);
  std::vector<LightImportance::Site> places = std::move(from_receivers.places);
  parallel_for(places.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Rng rng(asked.seed, Stage::pilot, kPlaces, k);
      places[k].value = relevance.of(places[k], places[k].normal, rng);
    }
  });

  std::vector<EmissionGuide::Observation> seen;
  for (int round = 0; round < kRounds; ++round) {
    ParticleSettings settings;
    settings.seed = asked.seed, settings.stage = Stage::pilot;
    settings.paths = asked.brief_survey ? kPathsPerRound / 2 : kPathsPerRound, settings.deepest = deepest;
    settings.first_id = static_cast<std::uint64_t>(round + 1) << 40;  // numbers of its own
    settings.guide = &aim.guide, settings.lobes = asked.lobes.unwidened();
    settings.paths = paths_worth_tracing(world, choice, settings);
    const Round found = run_round(world, choice, settings, relevance);
    seen.insert(seen.end(), found.seen.begin(), found.seen.end());
    places.insert(places.end(), found.places.begin(), found.places.end());
    aim.indirect = found.indirect;
    aim.guide = EmissionGuide::fit(seen);
  }
  aim.importance = LightImportance(places);
  return aim;
}

}  // namespace lumirank::transport
