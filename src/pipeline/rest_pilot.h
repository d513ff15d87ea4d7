// Pilot of the light that columns cannot carry: whether it matters in a view, and how many paths it takes to
// add it; found by a few thousand paths over the whole film, so that a crop, its size and its samples decide
// nothing.
#pragma once

#include <cstddef>
#include <vector>

#include "base/sinks.h"
#include "lumirank/settings.h"
#include "pipeline/recipe.h"
#include "world/world.h"

namespace lumirank::pipeline {

struct RestPilot {
  double share = 0;  // of the light that surfaces send to the eye (emission seen directly left out)
  double without_brightest = 0;   // the same without the brightest of the paths: one path decides nothing
  double seen = 0;                // seen_share()
  double deviation = 0;           // of one path per pixel, over that light: Σ standard deviation / Σ light
  double path_seconds = 0;        // of one such path, all threads at work
  double whole_path_seconds = 0;  // of one that carries all light
  bool matters() const { return without_brightest > kMinShare || seen > kMinSeen; }
  // pathtrace::Paths per pixel whose noise is as large as the error allowed for it, within reason.
  int paths() const;

  // Half a percent: a tenth of what the columns' own error is by default (5 % and more on interiors). Below
  // that the noise of any affordable number of paths is larger than the light that they bring.
  static constexpr double kMinShare = 0.005;
  // A thousandth: a caustic that doubles the light of as much of the film is missed there, though it is a
  // small part of all light. Where such light is spread, a pilot's blocks have one path of it or none, and it
  // is 0.
  static constexpr double kMinSeen = 0.001;
  // Of light that paths from the emitters show and those from the eye hardly find. It takes many paths:
  // below 0.018 two scenes of four were worse with it in ten seconds.
  static constexpr double kMinShown = 0.02;
  // Relative L1 of the picture that the paths' noise may add. In quadrature with 5 % it is a twelfth of that.
  static constexpr double kNoise = 0.02;
  static constexpr int kMinPaths = 16, kMaxPaths = 64;
};

// Paths of one pixel of a pilot.
struct PilotPixel {
  double mean = 0, deviation = 0, brightest = 0;  // the last: what the brightest of them adds to the mean
};

// The mean over blocks of 4×4 pixels of the part of their light that is rest, without the brightest path of
// each: what is found in a place by several paths is a shape that eyes see, however little of all light it
// is. Light counts as a tenth of the usual at least. `width`: pixels in a row.
double seen_share(const std::vector<PilotPixel>& rest, const std::vector<PilotPixel>& all, std::size_t width);

RestPilot pilot_rest(const world::World& world, const View& view, const RenderSettings& settings,
                     const Sinks& sinks);

// What the settings' `rest` comes to.
struct RestPlan {
  int paths = 0;           // per pixel; 0: none are traced
  double light_paths = 0;  // from the emitters, beside each of them
  bool aim_light_paths = false;
  bool piloted = false;
  RestPilot pilot;
};
// Whether what traces the rest can trace light paths as well: not over the instants of an open shutter.
enum class LightPaths { none, beside };
RestPlan plan_rest(const world::World& world, const View& view, const RenderSettings& settings,
                   LightPaths light_paths, const Sinks& sinks);

}  // namespace lumirank::pipeline
