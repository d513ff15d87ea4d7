#include "pipeline/rest_pilot.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/timer.h"
#include "pathtrace/light_targets.h"
#include "pipeline/light_path_pilot.h"

namespace lumirank::pipeline {
namespace {

constexpr double kPilotPixels = 2048;
constexpr int kRestPaths = 4, kAllPaths = 2;  // of each pixel

double wanted_light(const pathtrace::Radiance& r, LightPart only) {
  double y = 0;
  if (only != LightPart::indirect) y += static_cast<double>(luminance(r.direct));
  if (only != LightPart::direct) y += static_cast<double>(luminance(r.indirect));
  return y;
}

}  // namespace

double seen_share(const std::vector<PilotPixel>& rest, const std::vector<PilotPixel>& all,
                  std::size_t width) {
  constexpr std::size_t kBlock = 4;
  double usual = 0, seen = 0;
  for (const PilotPixel& p : all) usual += p.mean / static_cast<double>(all.size());
  const std::size_t height = all.size() / width;
  for (std::size_t y0 = 0; y0 < height; y0 += kBlock)
    for (std::size_t x0 = 0; x0 < width; x0 += kBlock) {
      double of_rest = 0, of_all = 0, brightest = 0, pixels = 0;
      for (std::size_t y = y0; y < std::min(height, y0 + kBlock); ++y)
        for (std::size_t x = x0; x < std::min(width, x0 + kBlock); ++x, ++pixels) {
          const PilotPixel& r = rest[y * width + x];
          of_rest += r.mean, of_all += all[y * width + x].mean;
          brightest = std::max(brightest, r.brightest);
        }
      const double light = std::max(of_all, of_rest) + 0.1 * usual * pixels;
      if (light > 0) seen += (of_rest - brightest) / light * pixels;
    }
  return seen / static_cast<double>(all.size());
}

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
  const auto trace = [&](const pathtrace::PathTracer& tracer, int paths) {
    std::vector<PilotPixel> found(pixels);
    parallel_for(pixels, 64, [&](std::size_t begin, std::size_t end) {
      if (sinks.cancelled()) return;
      for (std::size_t p = begin; p < end; ++p) {
        double sum = 0, squares = 0, brightest = 0;
        for (int k = 0; k < paths; ++k) {
          const auto number = static_cast<std::uint64_t>(k);
          Rng random(seed, Stage::reference, ~static_cast<std::uint64_t>(p), number);
          const Vec2f jitter = random.next_2d();
          const Vec2f film{static_cast<float>(p % width) + jitter.x,
                           static_cast<float>(p / width) + jitter.y};
          const double y =
              wanted_light(tracer.trace(camera.ray(film, random.next_2d()), p, number), settings.view.only);
          sum += y, squares += y * y, brightest = std::max(brightest, y / paths);
        }
        const double mean = sum / paths;
        found[p] = {mean, std::sqrt(std::max(0.0, squares - sum * mean) / std::max(1, paths - 1)), brightest};
      }
    });
    return found;
  };
  const Timer timer;
  const std::vector<PilotPixel> rest_found = trace(rest, kRestPaths);
  const double of_rest = timer.seconds() / static_cast<double>(pixels * kRestPaths);
  const Timer all_timer;
  const std::vector<PilotPixel> all_found = trace(all, kAllPaths);
  const double of_all = all_timer.seconds() / static_cast<double>(pixels * kAllPaths);
  PilotPixel found;
  double light = 0;
  for (const PilotPixel& p : rest_found)
    found.mean += p.mean, found.deviation += p.deviation,
        found.brightest = std::max(found.brightest, p.brightest);
  for (const PilotPixel& p : all_found) light += p.mean;
  if (sinks.cancelled()) throw Cancelled();
  RestPilot pilot;
  // The first paths warm the caches; others, which are longer, bound what they take.
  pilot.path_seconds = std::min(of_rest, of_all);
  pilot.whole_path_seconds = of_all;
  // Where only the rest was met, all of the light is rest.
  const double base = std::max(light, found.mean);
  if (base > 0)
    pilot.share = found.mean / base, pilot.without_brightest = (found.mean - found.brightest) / base,
    pilot.deviation = found.deviation / base;
  pilot.seen = seen_share(rest_found, all_found, width);
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
  if (light_paths == LightPaths::none) return plan;
  // What the pilot's paths from the eye hardly find, paths from the emitters may show: by what sends light on
  // sharply, if there is any.
  if (plan.paths == 0 && pathtrace::LightTargets(world, {}).empty()) return plan;
  const LightPathPilot light =
      pilot_light_paths(world, view, settings.seed, pathtrace::Paths::rest, settings.time, sinks);
  if (plan.paths == 0 && !(light.light_paths > 0 && light.shown > RestPilot::kMinShown)) return plan;
  plan.light_paths = light.light_paths, plan.aim_light_paths = light.aim;
  if (!plan.piloted) return plan;
  plan.pilot.deviation *= std::sqrt(light.variance);
  plan.pilot.path_seconds *= light.seconds;
  plan.paths = plan.pilot.paths();
  return plan;
}

}  // namespace lumirank::pipeline
