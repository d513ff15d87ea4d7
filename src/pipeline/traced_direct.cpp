#include "pipeline/traced_direct.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"
#include "base/sample_stream.h"

namespace lumirank::pipeline {
namespace {

// The emission met along a ray, passing through whatever lets light pass straight; a cut-out is decided at
// random.
struct Met {
  Rgb radiance{0};
  float light_pdf = 0;  // with which world::LightSampler would have found it
};
Met emission_along(const world::World& world, const world::LightSampler& lights,
                   const emitters::LitPoint& from, Vec3f origin, Vec3f direction, SampleStream& random) {
  constexpr int kMaxPasses = 64;
  Rgb through{1};
  float traveled = 0;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const auto hit = world.intersect({origin, direction});
    if (!hit) {
      const auto seen = lights.background(from, direction);
      return {through * seen.radiance, seen.pdf};
    }
    traveled += hit->hit.t;
    if (hit->emitter >= 0) {
      const Rgb emitted = world.emitted(*hit, -direction);
      if (!is_black(emitted)) return {through * emitted, lights.pdf_hit(from, *hit, direction, traveled)};
    }
    using Passage = scatter::MaterialSet::Passage;
    const Passage passage = world.materials().passage(hit->material);
    if (passage == Passage::opaque) return {};
    if (passage == Passage::cutout) {
      if (random.next_float() < world.materials().opacity(hit->material, hit->point.uv)) return {};
    } else {
      through *= world.materials().transmittance(hit->material, hit->point, -direction);
      if (is_black(through)) return {};
    }
    origin = world::World::offset_origin(hit->point.position, hit->point.ng, direction);
  }
  return {};
}

// Adds the samples begin … end − 1 to the sum of those before.
Rgb add_direct_at(const world::World& world, const world::LightSampler& lights,
                  const transport::Receivers& receivers, std::size_t i, const TracedDirectSettings& settings,
                  int begin, int end, Rgb sum) {
  using scatter::Lobes;
  const scatter::Closure closure = scatter::sharp_part(receivers.closure_at(i), settings.below);
  const Vec3f position = receivers.position[i], ng = receivers.ng[i], wo = receivers.wo[i];
  const emitters::LitPoint at = world::lit_point(position, closure, wo);
  const std::uint64_t key = pass_key(receivers.key(i), settings.pass);
  for (int k = begin; k < end; ++k) {
    const std::uint64_t number = pass_sample(k, end, settings.pass);
    SampleStream random(settings.seed, Stage::traced_direct, key, number);
    const auto [u_light, u_lobe] = random.next_fine();
    const auto s = lights.sample(at, u_light, random.next_2d());
    if (s.pdf > 0) {
      const Rgb f = scatter::eval(closure, wo, s.direct.direction);
      if (!is_black(f)) {
        const float bsdf_pdf =
            s.direct.delta ? 0.0f : scatter::pdf(closure, wo, s.direct.direction, Lobes::non_delta);
        const Rgb visible =
            world::visible_fraction(world, position, ng, s.direct.direction, s.direct.distance,
                                    hash_ids(settings.seed, Stage::opacity, key, number));
        sum += f * s.direct.radiance * visible * (1 / (s.pdf + bsdf_pdf));
      }
    }
    const auto b = scatter::sample(closure, wo, u_lobe, random.next_2d(), Lobes::non_delta);
    if (!b || is_black(b->weight)) continue;
    const Met met =
        emission_along(world, lights, at, world::World::offset_origin(position, ng, b->wi), b->wi, random);
    if (!is_black(met.radiance)) sum += b->weight * met.radiance * (b->pdf / (b->pdf + met.light_pdf));
  }
  return sum;
}

}  // namespace

bool is_traced(const transport::Receivers& receivers, std::size_t i, float below) {
  if (receivers.closure[i] == transport::Receivers::kLambertian) return below > 1;
  return receivers.closure_at(i).roughness() < below;
}

DirectTracing::DirectTracing(const world::World& world, const transport::Receivers& receivers,
                             const TracedDirectSettings& settings)
    : world_(world),
      receivers_(receivers),
      settings_(settings),
      lights_(world.light_sampler()),
      sums_(receivers.size()) {}

bool DirectTracing::add(int samples, const Sinks& sinks) {
  std::atomic<std::size_t> done{0};
  constexpr std::size_t kGrain = 1024;
  const int end_sample = samples_ + samples;
  parallel_for(receivers_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    if (sinks.cancelled()) return;
    for (std::size_t i = begin; i < end; ++i) {
      if (settings_.max_depth >= 0 && receivers_.depth[i] + 1 > settings_.max_depth) continue;
      if (is_traced(receivers_, i, settings_.below))
        sums_[i] = add_direct_at(world_, lights_, receivers_, i, settings_, samples_, end_sample, sums_[i]);
    }
    sinks.report("traced direct",
                 static_cast<double>(done += end - begin) / static_cast<double>(receivers_.size()));
  });
  samples_ = end_sample;
  return !sinks.cancelled();
}

std::vector<Rgb> DirectTracing::radiance() const {
  std::vector<Rgb> mean(sums_.size());
  const float inv_n = 1.0f / static_cast<float>(std::max(1, samples_));
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = sums_[i] * inv_n;
  return mean;
}

std::vector<Rgb> trace_direct(const world::World& world, const transport::Receivers& receivers,
                              const TracedDirectSettings& settings, const Sinks& sinks) {
  DirectTracing tracing(world, receivers, settings);
  tracing.add(settings.samples, sinks);
  return tracing.radiance();
}

}  // namespace lumirank::pipeline
