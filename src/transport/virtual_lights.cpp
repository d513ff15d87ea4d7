#include "transport/virtual_lights.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "transport/emitter_lights.h"
#include "transport/guide_pilot.h"
#include "transport/halves.h"
#include "transport/neighbour_distance.h"
#include "transport/particle.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kPilotPaths = 4096;
constexpr std::size_t kPathsPerPiece = 1024;
// Neither direct nor indirect light gets a smaller share of the lights than this, if there is any of it;
// direct light never more than half, because a column more costs it nothing in rank and indirect light needs
// them.
constexpr double kLeastShare = 0.1, kGreatestDirectShare = 0.5;
// Where hardly any particle meets a surface, this many paths per light are the end of the search.
constexpr double kMostPathsPerLight = 32;
constexpr int kNeighbour = 10;

struct Pilot {
  double lights_per_path = 0;
  double direct_share = 1;  // of the power: what arrives from emitters over that plus what surfaces send on
};

Pilot run_pilot(const world::World& world, const EmitterChoice& choice, const EmissionGuide& guide,
                const LightSettings& settings, int deepest) {
  struct Sums {
    double lights = 0, first = 0, scattered = 0;
    Sums operator+(const Sums& o) const {
      return {lights + o.lights, first + o.first, scattered + o.scattered};
    }
  };
  const ParticleTracer tracer(
      world, choice, {settings.seed, Stage::pilot, kPilotPaths, deepest, 0, &guide, settings.diffuse_only});
  const Sums sums =
      parallel_sum(kPilotPaths, std::size_t{256}, Sums{}, [&](std::size_t begin, std::size_t end) {
        LightBatch batch;
        PathTally tally;
        for (std::size_t path = begin; path < end; ++path) tracer.trace(path, batch, &tally);
        return Sums{static_cast<double>(batch.lights.size()), tally.first_flux, tally.scattered_flux};
      });
  Pilot pilot;
  pilot.lights_per_path = sums.lights / static_cast<double>(kPilotPaths);
  if (sums.first + sums.scattered > 0) pilot.direct_share = sums.first / (sums.first + sums.scattered);
  return pilot;
}

struct Counts {
  std::size_t direct = 0, paths = 0;
};

Counts divide(const LightSettings& settings, const DirectNeed& need, const Pilot& pilot, bool direct,
              bool indirect) {
  const auto target = static_cast<double>(settings.count);
  Counts counts;
  double for_paths = 0;
  if (indirect) {
    const double share = direct ? std::clamp(pilot.direct_share, kLeastShare, kGreatestDirectShare) : 0.0;
    double for_direct = share * target;
    if (direct && !need.sampled) for_direct = std::min(for_direct, static_cast<double>(need.least));
    // Many lamps: each its own column as long as that leaves half to indirect light.
    if (direct) for_direct = std::max(for_direct, std::min(static_cast<double>(need.least), 0.5 * target));
    counts.direct = direct ? std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(for_direct))) : 0;
    for_paths = std::max(1.0, target - static_cast<double>(counts.direct));
    const double per_light = pilot.lights_per_path > 0 ? 1 / pilot.lights_per_path : kMostPathsPerLight;
    counts.paths =
        even(static_cast<std::size_t>(std::ceil(for_paths * std::min(per_light, kMostPathsPerLight))));
  } else if (direct) {
    counts.direct = need.sampled ? settings.count : std::min(settings.count, need.least);
  }
  return counts;
}

void trace_particles(const world::World& world, const EmitterChoice& choice, const ParticleSettings& settings,
                     std::span<LightBatch> pieces, const Sinks& sinks) {
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

// The area that a surface light stands for: a disc that holds ten lights has a tenth of it for each. Each
// half is measured by itself, for clamping would otherwise couple the two; a light of it stands for as much
// less as there are more lights in both.
void measure_areas(VirtualLights& lights, float scene_radius) {
  std::vector<std::size_t> which[2];
  std::vector<Vec3f> points[2];
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (lights.kind[j] != LightKind::surface) continue;
    const std::size_t h = lights.half[j] == 2 ? 1 : 0;
    which[h].push_back(j);
    points[h].push_back(lights.position[j]);
  }
  const auto all = static_cast<float>(which[0].size() + which[1].size());
  for (std::size_t h = 0; h < 2; ++h) {
    const std::size_t n = which[h].size();
    if (n == 0) continue;
    const float share = static_cast<float>(n) / all;
    if (n == 1) {
      lights.area[which[h][0]] = kPi * square(scene_radius) * share;
      continue;
    }
    const auto k = static_cast<float>(std::min<std::size_t>(kNeighbour, n - 1));
    const std::vector<float> distance2 = neighbour_distance_squared(points[h], kNeighbour);
    for (std::size_t i = 0; i < n; ++i) lights.area[which[h][i]] = kPi * distance2[i] / k * share;
  }
}

}  // namespace

VirtualLights trace_virtual_lights(const world::World& world, const LightSettings& settings,
                                   const Sinks& sinks) {
  if (settings.count < 1) throw InputError("the number of virtual lights is 0", "ask for at least 1");
  const EmitterChoice choice(world);
  if (choice.empty()) return {};
  const bool unlimited = settings.max_depth < 0;
  // A light of depth k, seen by a receiver at the first hit, makes a path of depth k + 2.
  const bool direct = settings.direct && (unlimited || settings.max_depth >= 2);
  bool indirect = settings.indirect && (unlimited || settings.max_depth >= 3);
  const int deepest = unlimited ? -1 : settings.max_depth - 2;

  Pilot pilot;
  EmissionGuide guide;
  if (indirect) {
    if (settings.receivers) guide = learn_guide(world, choice, settings, deepest);
    pilot = run_pilot(world, choice, guide, settings, deepest);
    // Nothing that the emitters reach scatters: all lights may go to them.
    if (pilot.lights_per_path == 0 && direct) indirect = false;
  }
  const Counts counts = divide(settings, direct_need(world, choice), pilot, direct, indirect);
  std::vector<LightBatch> batches(1 + (counts.paths + kPathsPerPiece - 1) / kPathsPerPiece);
  batches[0] = emitter_lights(world, choice, settings.seed, counts.direct);
  const std::size_t direct_count = batches[0].lights.size();
  if (counts.paths > 0)
    trace_particles(
        world, choice,
        {settings.seed, Stage::particles, counts.paths, deepest, 0, &guide, settings.diffuse_only},
        std::span(batches).subspan(1), sinks);
  VirtualLights lights = lay_out(batches);
  lights.paths = counts.paths;
  lights.direct_count = direct_count;
  measure_areas(lights, world.bounds().radius());
  return lights;
}

scatter::Closure VirtualLights::closure_at(std::size_t j) const {
  if (closure[j] != kLambertian) return closures.get(closure[j], normal[j], ng[j]);
  scatter::Closure c;
  c.frame = Frame::from_normal(normal[j]);
  c.ng = ng[j];
  scatter::Lobe lobe;
  lobe.kind = scatter::LobeKind::diffuse;
  lobe.color = albedo[j];
  c.add(lobe);
  return c;
}

std::size_t VirtualLights::memory_bytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(kind) + bytes(position) + bytes(normal) + bytes(ng) + bytes(power) + bytes(area) +
         bytes(radius) + bytes(hidden) + bytes(emitter) + bytes(depth) + bytes(half) + bytes(closure) +
         bytes(albedo) + bytes(incoming) + bytes(spots) + closures.memory_bytes();
}

}  // namespace lumirank::transport
