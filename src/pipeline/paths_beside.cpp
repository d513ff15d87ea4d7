#include "pipeline/paths_beside.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/timer.h"
#include "pipeline/light_path_pilot.h"

namespace lumirank::pipeline {
namespace {

constexpr double kOfUsual = 0.1;
// From which noise on the denoised pictures of fifteen scenes are worse by passes (docs/decisions.md).
constexpr double kPassesLookWorse = 1.7, kWorseThanWithLightPaths = 2;

pathtrace::ReferenceOptions all_light(const RenderSettings& settings, const LightPathPilot& light,
                                      methods::TimedChoices* choices) {
  pathtrace::ReferenceOptions options =
      reference_options(settings.view.only, hash_ids(settings.seed, Stage::pilot), ReferencePaths::all);
  options.light_paths = light.light_paths, options.aim_light_paths = light.aim;
  if (choices) choose_light_paths(*choices, "beside", options.light_paths, options.aim_light_paths);
  return options;
}

// Light is missed over so many pixels a side together, beyond so many deviations.
constexpr int kMissedTogether = 8;
constexpr double kSureOfMissed = 2;
// A thousandth of the light missed is as bad as a quarter more noise (docs/decisions.md): it is all in few
// places. So much of it may be chance.
constexpr double kNoiseOfMissed = 250, kMissedByChance = 0.001;
constexpr double kLateOfPath = 0.3, kLateOfBudget = 0.01;

// Over what is usual around a pixel: a pixel's own noise is in its own value, and few paths that found
// something bright would hide how bright that was.
constexpr int kAround = 16;

double brightness(Rgb c) { return static_cast<double>(c.r + c.g + c.b) / 3; }

double relative_size(const image::Image& difference, const image::Image& picture) {
  double usual = 0;
  for (const Rgb& p : picture.pixels) usual += brightness(p);
  usual *= kOfUsual / static_cast<double>(picture.pixels.size());
  if (!(usual > 0)) return 0;
  double sum = 0;
  for (int y = 0; y < picture.height; y += kAround)
    for (int x = 0; x < picture.width; x += kAround) {
      double off = 0, light = 0;
      int pixels = 0;
      for (int v = y; v < std::min(y + kAround, picture.height); ++v)
        for (int u = x; u < std::min(x + kAround, picture.width); ++u, ++pixels) {
          const Rgb d = difference.at(u, v);
          off += brightness({std::abs(d.r), std::abs(d.g), std::abs(d.b)});
          light += brightness(picture.at(u, v));
        }
      sum += pixels * off / (light + pixels * usual);
    }
  return sum / 2 / static_cast<double>(picture.pixels.size());
}

double worse_for_missing(const NoisyPicture& passes, const NoisyPicture& paths) {
  const double beyond = missed_light(paths, passes) - missed_light(passes, paths) - kMissedByChance;
  return 1 + kNoiseOfMissed * std::max(0.0, beyond);
}

}  // namespace

PathsBeside::PathsBeside(const world::World& world, const View& view, const RenderSettings& settings,
                         methods::TimedChoices* choices, const Sinks& sinks)
    : pilot_(pilot_light_paths(world, view, settings.seed, pathtrace::Paths::all, settings.time, sinks)),
      options_(all_light(settings, pilot_, choices)),
      film_(world, view, options_) {}

bool PathsBeside::add(int paths, const Sinks& sinks) {
  const Timer timer;
  const bool whole = film_.add(paths, sinks);
  seconds_ += timer.seconds();
  return whole;
}

double own_emission_over_apart(const PathsBeside& now, double paths) {
  return own_emission_over_apart(now.picture(), now.difference(), now.sent_difference(), now.paths(), paths);
}

double own_emission_over_apart(const image::Image& picture, const image::Image& all, const image::Image& sent,
                               double paths_now, double paths) {
  // Film samples of an edge, of one that glares, and for each path (pixel_features.h,
  // paths_after_passes.cpp).
  constexpr double kAtEdges = 16, kGlaring = 48, kForPath = 1.0 / 8;
  double usual = 0, own = 0, apart = 0;
  for (const Rgb& p : picture.pixels) usual += brightness(p);
  usual *= kOfUsual / static_cast<double>(std::max<std::size_t>(1, picture.pixels.size()));
  const double fewer = std::sqrt(paths_now / std::max(paths, 1.0));  // noise that is left by then
  for (std::size_t p = 0; p < picture.pixels.size(); ++p) {
    const double light = brightness(picture.pixels[p]) + usual;
    if (!(light > 0)) continue;
    const auto size = [&](Rgb d) {
      return brightness({std::abs(d.r), std::abs(d.g), std::abs(d.b)}) / light;
    };
    const double of_emission = size(all.pixels[p] - sent.pixels[p]);
    const double samples = kAtEdges + kForPath * paths + (of_emission > 1 ? kGlaring : 0);
    own += fewer * size(all.pixels[p]);
    apart += std::hypot(fewer * size(sent.pixels[p]), std::sqrt(paths_now / samples) * of_emission);
  }
  return apart > 0 ? own / apart : 1;
}

int paths_that_fit(double left, double each, double budget) {
  const double late = std::min(kLateOfPath * each, kLateOfBudget * budget);
  return static_cast<int>(std::clamp((left + late) / each, 0.0, 1.0 * (1 << 20)));
}

double missed_light(const NoisyPicture& shown, const NoisyPicture& missing) {
  const image::Image &more = shown.picture, &less = missing.picture;
  double usual = 0;
  for (const Rgb& p : more.pixels) usual += brightness(p);
  usual *= kOfUsual / static_cast<double>(std::max<std::size_t>(1, more.pixels.size()));
  double missed = 0;
  for (int y = 0; y < more.height; y += kMissedTogether)
    for (int x = 0; x < more.width; x += kMissedTogether) {
      double light = 0, other = 0, apart = 0, other_apart = 0;
      int pixels = 0;
      for (int v = y; v < std::min(y + kMissedTogether, more.height); ++v)
        for (int u = x; u < std::min(x + kMissedTogether, more.width); ++u, ++pixels) {
          light += brightness(more.at(u, v)), other += brightness(less.at(u, v));
          if (!shown.difference.pixels.empty()) apart += brightness(shown.difference.at(u, v));
          if (!missing.difference.pixels.empty()) other_apart += brightness(missing.difference.at(u, v));
        }
      const double lacks = light - other - kSureOfMissed * std::hypot(apart, other_apart) / 2;
      if (lacks > 0) missed += pixels * lacks / (light + pixels * usual);
    }
  return missed / static_cast<double>(std::max<std::size_t>(1, more.pixels.size()));
}

double passes_over_paths(const NoisyPicture& passes, double seconds_of_passes, const NoisyPicture& paths,
                         double seconds_of_paths, bool light_paths) {
  image::Image picture = passes.picture;
  for (std::size_t p = 0; p < picture.pixels.size(); ++p)
    picture.pixels[p] = 0.5f * (picture.pixels[p] + paths.picture.pixels[p]);
  const double by_paths = relative_size(paths.difference, picture) * std::sqrt(seconds_of_paths);
  const double by_passes = relative_size(passes.difference, picture) * std::sqrt(seconds_of_passes);
  const double worse = light_paths ? kWorseThanWithLightPaths : kPassesLookWorse;
  return by_paths > 0 ? worse_for_missing(passes, paths) * worse * by_passes / by_paths : 0;
}

double share_of_passes(double ratio, double seconds_of_passes, double seconds_of_paths) {
  const double of_paths = ratio * ratio * seconds_of_paths;
  return seconds_of_passes > 0 ? seconds_of_passes / (seconds_of_passes + of_paths) : 0;
}

}  // namespace lumirank::pipeline
