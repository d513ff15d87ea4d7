// Light that columns cannot carry, traced beside them (TracedLightSettings::rest): whether it matters, when
// its paths are traced, and how many.
#pragma once

#include <memory>

#include "base/timer.h"
#include "methods/common/timed_choices.h"
#include "pathtrace/reference.h"
#include "pipeline/prepared.h"
#include "pipeline/rest_pilot.h"
#include "pipeline/timed_passes.h"

namespace lumirank::pipeline {

class RestTracing {
 public:
  // Pilots where the settings leave it open.
  RestTracing(SharedWorld world, const View& view, const RenderSettings& settings, const Sinks& sinks);

  // By a plan that has been made for several views.
  RestTracing(SharedWorld world, const RenderSettings& settings, const RestPlan& plan);

  // Plans as an earlier run did, whatever its own pilot says: in another frame of a shot.
  void choose(methods::TimedChoices& choices);

  const RestPlan& plan() const { return plan_; }
  double pilot_seconds() const { return pilot_seconds_; }
  // Of one of its paths for each pixel, as the pilot says; 0: there was none.
  double seconds_of_path(const View& view) const {
    return plan_.pilot.path_seconds * static_cast<double>(view.width) * static_cast<double>(view.height);
  }
  // Of a path of all light for each pixel.
  double seconds_of_whole_path(const View& view) const {
    return plan_.pilot.whole_path_seconds * static_cast<double>(view.width) *
           static_cast<double>(view.height);
  }

  // Under a budget: the first paths before the method, which fills it. `earlier` > 0: a repetition's number
  // of paths. Throws Cancelled.
  void begin(const View& view, int earlier, double deadline, const Clock& clock, const Sinks& sinks);
  bool begun() const { return film_ != nullptr; }
  // More of them until the clock says so; false if it was cancelled.
  bool add_until(double until, const Clock& clock, const Sinks& sinks);
  // So many paths more, whatever the clock says; false if it was cancelled.
  bool add_paths(const View& view, int paths, const Sinks& sinks);
  // Without a budget all at once, after the method. False if it was interrupted.
  bool trace_all(const View& view, const Sinks& sinks);

  // Paths beside a pass that takes so many seconds and has so much noise (relative L1): two sorts of noise
  // are least together, for their seconds, where each has samples in proportion to its deviation over the
  // root of what a sample takes. Needs a pilot.
  double paths_beside_pass(const View& view, double pass_seconds, double noise_of_pass) const;
  static constexpr double kMinBesidePass = 0.25, kMaxBesidePass = 8;

  double light_paths() const { return options_.light_paths; }  // beside each of them
  bool aims_light_paths() const { return options_.aim_light_paths; }
  int paths() const { return paths_; }  // traced, per pixel
  double seconds() const { return seconds_; }
  void add_to(image::Image& image) const;             // nothing if none were traced
  void add_difference_to(image::Image& image) const;  // twice the noise of that

  static constexpr int kMaxPaths = 4096;  // beyond which more is not seen

 private:
  bool add(int paths, const Sinks& sinks);

  SharedWorld world_;
  pathtrace::ReferenceOptions options_;
  RestPlan plan_;
  double pilot_seconds_ = 0, seconds_ = 0, pace_ = 0;
  std::unique_ptr<pathtrace::PathFilm> film_;
  image::Image all_;  // of trace_all()
  int paths_ = 0;
};

}  // namespace lumirank::pipeline
