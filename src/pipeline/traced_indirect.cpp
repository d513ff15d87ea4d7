#include "pipeline/traced_indirect.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "base/sample_stream.h"
#include "pathtrace/path_tracer.h"
#include "pipeline/traced_direct.h"

namespace lumirank::pipeline {
namespace {

struct PathMoments {
  Rgb mean{0};
  float variance = 0;  // of one path's luminance
};

class Tracing {
 public:
  Tracing(const world::World& world, const transport::Receivers& receivers,
          const TracedIndirectSettings& settings)
      : receivers_(receivers),
        settings_(settings),
        of_columns_(world, {settings.seed, settings.max_depth, pathtrace::Paths::columns, {}}),
        of_gathered_(world, {settings.seed, settings.max_depth, pathtrace::Paths::all, {}}),
        reach_{[near = settings.near](Vec3f place) { return near->at(place); },
               settings.near ? settings.near->max_reach() : kInfinity} {}

  bool wants(std::size_t i) const {
    if (settings_.max_depth >= 0 && receivers_.depth[i] + 1 > settings_.max_depth) return false;
    if (settings_.near) return true;
    if (settings_.gathered && !receivers_.is_gathered(i)) return false;
    return is_traced(receivers_, i, settings_.below);
  }

  // pathtrace::Paths with an even number belong to the picture, odd ones to the pilot: two sets of numbers.
  PathMoments at(std::size_t i, int paths, bool pilot) const {
    scatter::Closure closure = receivers_.closure_at(i);
    if (!settings_.near) closure = scatter::sharp_part(closure, settings_.below);
    const Vec3f position = receivers_.position[i], wo = receivers_.wo[i];
    const std::uint64_t key = pass_key(receivers_.key(i), settings_.pass);
    const Stage stage = settings_.near ? Stage::traced_near : Stage::traced_sharp;
    pathtrace::PathTracer::Departure departure{
        position, receivers_.ng[i],    world::lit_point(position, closure, wo),
        {},       receivers_.depth[i], settings_.near ? &reach_ : nullptr};
    const pathtrace::PathTracer& tracer = receivers_.is_gathered(i) ? of_gathered_ : of_columns_;
    Rgb sum{0};
    double sum_y = 0, sum_y2 = 0;
    for (int k = 0; k < paths; ++k) {
      const std::uint64_t number = pass_sample(k, paths, settings_.pass) + (pilot ? 1 : 0);
      SampleStream random(settings_.seed, stage, key, number);
      const float u_lobe = random.next_2d().x;
      const auto next = scatter::sample(closure, wo, u_lobe, random.next_2d(), scatter::Lobes::non_delta);
      if (!next || is_black(next->weight)) continue;
      departure.next = *next;
      const Rgb light =
          tracer.indirect_after(departure, random, hash_ids(settings_.seed, stage, ~key, number));
      sum += light;
      const double y = luminance(light);
      sum_y += y, sum_y2 += y * y;
    }
    const double n = paths;
    return {sum * (1.0f / static_cast<float>(paths)),
            static_cast<float>(std::max(0.0, (sum_y2 - sum_y * sum_y / n) / std::max(1.0, n - 1)))};
  }

 private:
  const transport::Receivers& receivers_;
  TracedIndirectSettings settings_;
  pathtrace::PathTracer of_columns_, of_gathered_;
  pathtrace::Reach reach_;
};

// Neighbors on the film that share their number of paths.
constexpr std::size_t kGroup = 64;
// Of the paths, what finds out where they are needed, and what is spread evenly.
constexpr float kPilot = 0.125f, kEven = 0.25f;
constexpr int kFewestOfPilot = 4;
constexpr float kMaxWeight = 64;  // times the average

}  // namespace

std::vector<Rgb> per_sample(const transport::Receivers& receivers, const std::vector<Rgb>& values) {
  std::vector<Rgb> sums(receivers.samples());
  for (std::size_t i = 0; i < receivers.size(); ++i)
    sums[receivers.sample[i]] += receivers.weight[i] * values[i];
  return sums;
}

std::vector<Rgb> trace_indirect(const world::World& world, const transport::Receivers& receivers,
                                const TracedIndirectSettings& settings, const Sinks& sinks) {
  const Tracing tracing(world, receivers, settings);
  const std::size_t count = receivers.size(), groups = (count + kGroup - 1) / kGroup;
  std::vector<Rgb> radiance(count);
  std::vector<float> deviation(groups), wanted(groups);
  const int pilot = std::max(kFewestOfPilot, static_cast<int>(kPilot * static_cast<float>(settings.paths)));
  std::atomic<std::size_t> done{0};
  const auto for_groups = [&](const char* what, auto&& visit) {
    done = 0;
    parallel_for(groups, 4, [&](std::size_t begin, std::size_t end) {
      if (sinks.cancelled()) return;
      for (std::size_t g = begin; g < end; ++g)
        for (std::size_t i = g * kGroup; i < std::min(count, (g + 1) * kGroup); ++i)
          if (tracing.wants(i)) visit(g, i);
      sinks.report(what, static_cast<double>(done += end - begin) / static_cast<double>(groups));
    });
  };
  // A pilot would take longer than these: each receiver has its own number.
  if (settings.paths < kFewestOfPilot) {
    for_groups("traced indirect",
               [&](std::size_t, std::size_t i) { radiance[i] = tracing.at(i, settings.paths, false).mean; });
    return radiance;
  }
  // pathtrace::Paths in proportion to the deviation give the least squared error; the pilot's own are thrown
  // away, so that a number of paths knows nothing of the light that they bring.
  for_groups("pilot paths", [&](std::size_t g, std::size_t i) {
    const float weight = max_component(receivers.weight[i]);
    deviation[g] += weight * weight * tracing.at(i, pilot, true).variance;
    ++wanted[g];
  });
  double total = 0, all = 0;
  for (std::size_t g = 0; g < groups; ++g) {
    if (wanted[g] > 0) deviation[g] = std::sqrt(deviation[g] / wanted[g]);
    total += wanted[g] * deviation[g], all += wanted[g];
  }
  const float average = all > 0 ? static_cast<float>(total / all) : 0;
  for_groups("traced indirect", [&](std::size_t g, std::size_t i) {
    const float share = average > 0 ? std::min(kMaxWeight, deviation[g] / average) : 1;
    const float paths = static_cast<float>(settings.paths) * (kEven + (1 - kEven) * share);
    radiance[i] = tracing.at(i, std::max(1, static_cast<int>(std::lround(paths))), false).mean;
  });
  return radiance;
}

}  // namespace lumirank::pipeline
