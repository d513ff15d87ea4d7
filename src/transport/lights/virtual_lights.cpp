#include "transport/lights/virtual_lights.h"

#include <atomic>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "transport/lights/emitter_lights.h"
#include "transport/lights/gather_lights.h"
#include "transport/lights/light_areas.h"
#include "transport/lights/light_plan.h"
#include "transport/lights/particle.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kPathsPerPiece = 1024;

void trace_particles(const world::World& world, const world::EmitterChoice& choice,
                     const ParticleSettings& settings, std::span<LightBatch> pieces, const Sinks& sinks) {
  const ParticleTracer tracer(world, choice, settings);
  std::atomic<std::size_t> done{0};
  parallel_for(settings.paths, kPathsPerPiece, [&](std::size_t begin, std::size_t end) {
    if (sinks.cancelled()) return;
    LightBatch& batch = pieces[begin / kPathsPerPiece];
    for (std::size_t path = begin; path < end; ++path) tracer.trace(path, batch);
    batch.lights.shrink_to_fit();
    batch.closures.shrink();
    done += end - begin;
    sinks.report("virtual lights", static_cast<double>(done) / static_cast<double>(settings.paths));
  });
  if (sinks.cancelled()) throw Cancelled();
}

// On samples that may be those of other moments as well.
VirtualLights light_gather_samples(const world::World& world, const LightSurvey& survey,
                                   const LightSettings& settings, const Sinks& sinks) {
  GatherPlan own;
  if (!settings.gather) {
    const world::World* const worlds[] = {&world};
    const LightSurvey* const surveys[] = {&survey};
    own = plan_gather(worlds, surveys, settings);
  }
  const GatherPlan& plan = settings.gather ? *settings.gather : own;
  std::vector<LightBatch> batches;
  batches.push_back(emitter_lights(world, plan.emitters, settings.seed));
  const std::size_t direct_count = batches[0].lights.size();
  if (survey.parts.indirect)
    for (LightBatch& batch : gather_lights(world, plan, survey, settings))
      batches.push_back(std::move(batch));
  if (sinks.cancelled()) throw Cancelled();
  VirtualLights lights = lay_out(batches);
  lights.paths = plan.photons;
  lights.direct_count = direct_count;
  return lights;
}

}  // namespace

std::shared_ptr<const LightSurvey> survey_lights(const world::World& world, const LightSettings& settings) {
  const world::EmitterChoice choice(world);
  if (choice.empty()) return std::make_shared<LightSurvey>();
  return std::make_shared<LightSurvey>(survey_lights(world, choice, settings));
}

VirtualLights trace_virtual_lights(const world::World& world, const LightSettings& settings,
                                   const Sinks& sinks) {
  if (settings.count < 1) throw InputError("the number of virtual lights is 0", "ask for at least 1");
  const world::EmitterChoice choice(world);
  if (choice.empty()) return {};
  const auto made =
      settings.survey ? nullptr : std::make_unique<LightSurvey>(survey_lights(world, choice, settings));
  const LightSurvey& survey = settings.survey ? *settings.survey : *made;
  if (settings.on_gather_samples) return light_gather_samples(world, survey, settings, sinks);
  const LightPlan plan = plan_lights(settings.count, survey);
  std::vector<LightBatch> batches(1 + (plan.paths + kPathsPerPiece - 1) / kPathsPerPiece);
  batches[0] = emitter_lights(world, choice, settings.seed, plan.emitter_samples);
  const std::size_t direct_count = batches[0].lights.size();
  if (plan.paths > 0) {
    const LightRoulette roulette(survey.aim.importance, survey.level);
    trace_particles(world, choice,
                    {settings.seed, Stage::particles, plan.paths, survey.parts.deepest, 0, &survey.aim.guide,
                     settings.lobes, &roulette},
                    std::span(batches).subspan(1), sinks);
  }
  VirtualLights lights = lay_out(batches);
  lights.paths = plan.paths;
  lights.direct_count = direct_count;
  measure_areas(lights, world.bounds().radius());
  return lights;
}

scatter::Closure VirtualLights::closure_at(std::size_t j) const {
  if (closure[j] != kLambertian) return closures.get(closure[j], normal[j], ng[j]);
  return scatter::lambertian(albedo[j], normal[j], ng[j]);
}

std::uint32_t VirtualLights::key(std::size_t j) const {
  return static_cast<std::uint32_t>(mix64(id[j]) >> 32);
}

std::size_t VirtualLights::memory_bytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(kind) + bytes(position) + bytes(normal) + bytes(ng) + bytes(power) + bytes(area) +
         bytes(radius) + bytes(hidden) + bytes(emitter) + bytes(depth) + bytes(half) + bytes(id) +
         bytes(path) + bytes(closure) + bytes(albedo) + bytes(incoming) + bytes(spots) +
         closures.memory_bytes();
}

}  // namespace lumirank::transport
