#include "pipeline/rest_pilot.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/timer.h"
#include "pipeline/light_path_pilot.h"

namespace lumirank::pipeline {
namespace {

constexpr double kPilotPixels = 2048;
constexpr int kRestPaths = 4, kAllPaths = 2;  // of each pixel

struct PilotSums {
  double rest = 0, deviation = 0, all = 0, brightest = 0;
  PilotSums operator+(const PilotSums& o) const {
    return {rest + o.rest, deviation + o.deviation, all + o.all, std::max(brightest, o.brightest)};
  }
};

double wanted_light(const pathtrace::Radiance& r, LightPart only) {
  double y = 0;
  if (only != LightPart::indirect) y += static_cast<double>(luminance(r.direct));
  if (only != LightPart::direct) y += static_cast<double>(luminance(r.indirect));
  return y;
}

}  // namespace

int RestPilot::paths() const {
  // E|mean of N − truth| is √(2/π) of its deviation where N is not small.
  const double wanted = 2 / 3.14159265358979 * (deviation / kNoise) * (deviation / kNoise);
  return static_cast<int>(
      std::clamp(std::ceil(wanted), static_cast<double>(kMinPaths), static_cast<double>(kMaxPaths)));
}

RestPilot pilot_rest(const world::World& world, const View& view, const RenderSettings& settings,
                     const Sinks& sinks) {
  const std::uint64_t seed = hash_ids(settings.seed, Stage::pilot, ~1ull);  // paths of their own
  const pathtrace::PathTracer rest(world, {seed, view.max_depth, pathtrace::Paths::rest, {}}),
      all(world, {seed, view.max_depth, pathtrace::Paths::all, {}});
  const world::Camera camera(whole_film(view, kPilotPixels), world.units());
  const auto width = static_cast<std::size_t>(camera.width());
  const std::size_t pixels = width * static_cast<std::size_t>(camera.height());
  const auto trace = [&](const pathtrace::PathTracer& tracer, int paths, bool is_rest) {
    return parallel_sum(pixels, 64, PilotSums{}, [&](std::size_t begin, std::size_t end) {
      PilotSums sums;
      if (sinks.cancelled()) return sums;
      for (std::size_t p = begin; p < end; ++p) {
        double sum = 0, squares = 0;
        for (int k = 0; k < paths; ++k) {
          const auto number = static_cast<std::uint64_t>(k);
          Rng random(seed, Stage::reference, ~static_cast<std::uint64_t>(p), number);
          const Vec2f jitter = random.next_2d();
          const Vec2f film{static_cast<float>(p % width) + jitter.x,
                           static_cast<float>(p / width) + jitter.y};
          const double y =
              wanted_light(tracer.trace(camera.ray(film, random.next_2d()), p, number), settings.view.only);
          sum += y, squares += y * y;
          if (is_rest) sums.brightest = std::max(sums.brightest, y / paths);
        }
        const double mean = sum / paths;
        if (is_rest)
          sums.rest += mean,
              sums.deviation += std::sqrt(std::max(0.0, squares - sum * mean) / std::max(1, paths - 1));
        else
          sums.all += mean;
      }
      return sums;
    });
  };
  const Timer timer;
  const PilotSums found = trace(rest, kRestPaths, true);
  const double of_rest = timer.seconds() / static_cast<double>(pixels * kRestPaths);
  const Timer all_timer;
  const double light = trace(all, kAllPaths, false).all;
  const double of_all = all_timer.seconds() / static_cast<double>(pixels * kAllPaths);
  if (sinks.cancelled()) throw Cancelled();
  RestPilot pilot;
  // The first paths warm the caches; others, which are longer, bound what they take.
  pilot.path_seconds = std::min(of_rest, of_all);
  pilot.whole_path_seconds = of_all;
  // Where only the rest was met, all of the light is rest.
  const double base = std::max(light, found.rest);
  if (base > 0)
    pilot.share = found.rest / base, pilot.without_brightest = (found.rest - found.brightest) / base,
    pilot.deviation = found.deviation / base;
  return pilot;
}

RestPlan plan_rest(const world::World& world, const View& view, const RenderSettings& settings,
                   LightPaths light_paths, const Sinks& sinks) {
  RestPlan plan;
  if (settings.traced.rest == RestOfPaths::skip) return plan;
  if (settings.traced.rest == RestOfPaths::automatic) {
    plan.pilot = pilot_rest(world, view, settings, sinks);
    plan.piloted = true;
  }
  if (settings.traced.rest == RestOfPaths::trace)
    plan.paths = std::max(16, settings.view.spp_or_default());
  else if (plan.pilot.matters())
    plan.paths = plan.pilot.paths();
  if (plan.paths == 0 || light_paths == LightPaths::none) return plan;
  const LightPathPilot light = pilot_light_paths(world, view, settings.seed, pathtrace::Paths::rest, sinks);
  plan.light_paths = light.light_paths;
  if (!plan.piloted) return plan;
  plan.pilot.deviation *= std::sqrt(light.variance);
  plan.pilot.path_seconds *= light.seconds;
  plan.paths = plan.pilot.paths();
  return plan;
}

}  // namespace lumirank::pipeline
