#include "transport/guide_pilot.h"

#include <algorithm>

#include "base/bounds.h"
#include "base/parallel.h"
#include "transport/particle.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kPathsPerRound = 1 << 14;
constexpr int kRounds = 3;
constexpr int kPartners = 2;       // receivers asked about every light
constexpr float kNearest = 0.05f;  // nearer ones count as if this part of the receivers' extent away

class Relevance {
 public:
  Relevance(const world::World& world, const Receivers& receivers) : world_(world), receivers_(receivers) {
    Bounds3f box;
    for (const Vec3f p : receivers.position) box.extend(p);
    nearest2_ = square(kNearest * 2 * box.radius());
  }

  // What the light sends to some receivers, in the mean; visibility included.
  float of(const LightRecord& light, Rng& rng) const {
    const float reflectance =
        light.closure == VirtualLights::kLambertian ? max_component(light.albedo) : 0.5f;
    float sum = 0;
    for (int k = 0; k < kPartners; ++k) {
      const std::size_t i = rng.next_below(receivers_.size());
      const Vec3f to_light = light.position - receivers_.position[i];
      const float d2 = length_squared(to_light);
      if (!(d2 > 0)) continue;
      const Vec3f w = to_light / std::sqrt(d2);
      const float cosines =
          cosine(receivers_.normal[i], receivers_.ng[i], w) * cosine(light.normal, light.ng, -w);
      if (!(cosines > 0)) continue;
      const Vec3f from = world::World::offset_origin(receivers_.position[i], receivers_.ng[i], w);
      const Vec3f to = world::World::offset_origin(light.position, light.ng, -w);
      if (world_.rays().occluded({from, to - from, 0, 1 - 1e-4f}, rng.next_bits())) continue;
      sum += cosines / std::max(d2, nearest2_) * max_component(receivers_.weight[i]);
    }
    return sum * reflectance * max_component(light.power);
  }

 private:
  // A fibre (without a geometric normal) is met from everywhere, and π/4 is the mean of its sine.
  static float cosine(Vec3f n, Vec3f ng, Vec3f w) {
    return ng == Vec3f{} ? kPi / 4 : std::max(0.0f, dot(n, w));
  }

  const world::World& world_;
  const Receivers& receivers_;
  float nearest2_;
};

}  // namespace

EmissionGuide learn_guide(const world::World& world, const EmitterChoice& choice, const LightSettings& asked,
                          int deepest) {
  const Receivers& receivers = *asked.receivers;
  EmissionGuide guide;
  if (receivers.size() == 0 || choice.empty()) return guide;
  const Relevance relevance(world, receivers);
  std::vector<EmissionGuide::Observation> seen;
  for (int round = 0; round < kRounds; ++round) {
    ParticleSettings settings;
    settings.seed = asked.seed, settings.stage = Stage::pilot;
    settings.paths = kPathsPerRound, settings.deepest = deepest;
    settings.first_id = static_cast<std::uint64_t>(round + 1) << 40;  // numbers of its own
    settings.guide = &guide, settings.diffuse_only = asked.diffuse_only;
    const ParticleTracer tracer(world, choice, settings);
    const std::size_t first = seen.size();
    seen.resize(first + kPathsPerRound);
    parallel_for(kPathsPerRound, 256, [&](std::size_t begin, std::size_t end) {
      LightBatch batch;
      for (std::size_t path = begin; path < end; ++path) {
        batch.lights.clear();
        const EmissionGuide::Start start = tracer.trace(path, batch);
        Rng rng(asked.seed, Stage::pilot, settings.first_id + path, 1);
        auto& o = seen[first + path];
        o.at[0] = std::min(static_cast<float>(start.emitter), 0x1.fffffep-1f);
        std::copy(start.rest, start.rest + kStartDimensions - 1, o.at.begin() + 1);
        o.density = static_cast<float>(start.density);
        o.value = 0;
        for (const LightRecord& light : batch.lights) o.value += relevance.of(light, rng);
      }
    });
    guide = EmissionGuide::fit(seen);
  }
  return guide;
}

}  // namespace lumirank::transport
