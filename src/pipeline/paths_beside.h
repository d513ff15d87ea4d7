// Paths that carry all light, traced beside passes of rows and columns: which of both has less noise for its
// seconds is found on the picture itself.
#pragma once

#include "base/sinks.h"
#include "image/image.h"
#include "methods/common/timed_choices.h"
#include "pathtrace/reference.h"
#include "pipeline/light_path_pilot.h"
#include "pipeline/recipe.h"
#include "world/world.h"

namespace lumirank::pipeline {

class PathsBeside {
 public:
  // Must outlive it: the world. `choices`: where they are the run's own; none for a trial.
  PathsBeside(const world::World& world, const View& view, const RenderSettings& settings,
              methods::TimedChoices* choices, const Sinks& sinks);

  // So many more for each pixel. False if it was cancelled: then none of them counts.
  bool add(int paths, const Sinks& sinks);
  int paths() const { return film_.paths(); }
  const LightPathPilot& light_path_pilot() const { return pilot_; }
  double light_paths() const { return options_.light_paths; }  // beside each of them
  bool aims_light_paths() const { return options_.aim_light_paths; }
  double seconds() const { return seconds_; }
  double error() const { return film_.result().error; }  // relative L1, as halves state it
  // The picture, and twice its noise. Where a surface ends before a bright sky, what both send to a pixel is
  // by the same samples, and much of their noise cancels.
  image::Image picture() const { return film_.result().image; }
  image::Image difference() const { return film_.halves_difference(); }
  // Of what surfaces send, as passes have it.
  image::Image sent() const { return film_.sent(); }
  image::Image sent_difference() const { return film_.sent_difference(); }
  const pathtrace::PathFilm& film() const { return film_; }

 private:
  LightPathPilot pilot_;
  pathtrace::ReferenceOptions options_;
  pathtrace::PathFilm film_;
  double seconds_ = 0;
};

// Paths for each pixel that fit into `left` seconds of a budget, where one takes so long. The last of them
// may end a hundredth of the budget late, by less than a third of itself: no path can be divided, and on the
// average as much as half of one would be left unused.
int paths_that_fit(double left, double each, double budget);

// An estimate of a picture, with a difference that is twice its noise.
struct NoisyPicture {
  image::Image picture, difference;
};

// The part of the picture's light that one shows and another one misses: over what is there and a tenth of
// what is usual, in the mean over pixels, beyond the noise of both in small blocks. Not noise, but what no
// path may find at all (what is lit by a lamp within glass, and seen through glass), or what passes hold back
// (clamped, within rough glass). Either difference may be empty, where it is not known.
double missed_light(const NoisyPicture& shown, const NoisyPicture& missing);
inline constexpr double kMissedByPaths = 0.03;  // above that it is none of the passes' noise

// Noise of passes over that of paths for the same seconds, as eyes see it: over what is there and a tenth of
// what is usual, in the mean over pixels. That of passes counts worse than it is: it is alike in neighbors,
// which share lights, and a denoiser leaves more of it. Still worse beside light paths, without which the
// paths' own noise would be rare and bright. And worse where they miss light that paths show, beyond what
// paths miss.
double passes_over_paths(const NoisyPicture& passes, double seconds_of_passes, const NoisyPicture& paths,
                         double seconds_of_paths, bool light_paths);

// What passes count in the mean with paths, in 0 … 1, where it has the least variance: both by 1/variance.
// `ratio`: passes_over_paths().
double share_of_passes(double ratio, double seconds_of_passes, double seconds_of_paths);

// Noise of a picture with the emission that its own paths see over that with emission by film samples apart,
// both once there are `paths` for each pixel, as eyes see it. By its own paths, what a surface and the sky
// behind it send to a pixel is more when the other is less; a lamp's edge is no better for that, and film
// samples are many there.
double own_emission_over_apart(const PathsBeside& now, double paths);
// The same for pictures; `all`, `sent`: differences with and without emission, of which `paths_now` are the
// paths.
double own_emission_over_apart(const image::Image& picture, const image::Image& all, const image::Image& sent,
                               double paths_now, double paths);

}  // namespace lumirank::pipeline
