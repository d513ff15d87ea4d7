#include "pipeline/rest_tracing.h"

#include <cstdio>

#include "base/error.h"
#include "pipeline/light_path_pilot.h"

namespace lumirank::pipeline {

RestTracing::RestTracing(SharedWorld world, const View& view, const RenderSettings& settings,
                         const Sinks& sinks)
    : world_(std::move(world)),
      options_(reference_options(settings.view.only, settings.seed, ReferencePaths::rest)) {
  const Timer timer;
  plan_ = plan_rest(*world_, view, settings, LightPaths::beside, sinks);
  options_.light_paths = plan_.light_paths, options_.aim_light_paths = plan_.aim_light_paths;
  if (!plan_.piloted) return;
  pilot_seconds_ = timer.seconds();
  char share[32];
  std::snprintf(share, sizeof share, "%.2g %%", 100 * plan_.pilot.share);
  sinks.say(
      "light that columns cannot carry: " + std::string(share) +
      (plan_.paths > 0 && !plan_.pilot.matters() ? " by paths from the eye, more by paths from the emitters"
                                                 : "") +
      (plan_.paths > 0 ? ", traced with " + std::to_string(plan_.paths) + " paths per pixel"
       : plan_.pilot.share > RestPilot::kMinShare ? ", nearly all of it in one path of the pilot, left out"
                                                  : ", left out"));
}

RestTracing::RestTracing(SharedWorld world, const RenderSettings& settings, const RestPlan& plan)
    : world_(std::move(world)),
      options_(reference_options(settings.view.only, settings.seed, ReferencePaths::rest)),
      plan_(plan) {
  options_.light_paths = plan.light_paths, options_.aim_light_paths = plan.aim_light_paths;
}

void RestTracing::choose(methods::TimedChoices& choices) {
  if (const auto earlier = choices.earlier("rest_paths", kMaxPaths)) plan_.paths = static_cast<int>(*earlier);
  choices.record("rest_paths", plan_.paths);
  choose_light_paths(choices, "rest", plan_.light_paths, plan_.aim_light_paths);
  options_.light_paths = plan_.light_paths, options_.aim_light_paths = plan_.aim_light_paths;
}

bool RestTracing::add(int paths, const Sinks& sinks) {
  if (!film_->add(paths, sinks, [&](double fraction) { sinks.report("rest", fraction); })) return false;
  paths_ = film_->paths();
  return true;
}

void RestTracing::begin(const View& view, int earlier, double deadline, const Clock& clock,
                        const Sinks& sinks) {
  if (plan_.paths == 0) return;
  const Timer timer;
  film_ = std::make_unique<pathtrace::PathFilm>(*world_, view, options_);
  if (earlier > 0) {
    if (!add(earlier, sinks)) throw Cancelled();
  } else {
    const auto done =
        run_passes({0, 1, plan_.paths, deadline, 0}, clock, [&](int paths) { return add(paths, sinks); });
    if (done.cancelled) throw Cancelled();
    pace_ = done.pace;
  }
  seconds_ = timer.seconds();
}

bool RestTracing::add_until(double until, const Clock& clock, const Sinks& sinks) {
  if (!film_) return true;
  const Timer timer;
  const auto passes = run_passes({paths_, paths_, kMaxPaths, until, pace_}, clock,
                                 [&](int paths) { return add(paths, sinks); });
  seconds_ += timer.seconds();
  return !passes.cancelled;
}

bool RestTracing::add_paths(const View& view, int paths, const Sinks& sinks) {
  const Timer timer;
  if (!film_) film_ = std::make_unique<pathtrace::PathFilm>(*world_, view, options_);
  const bool whole = add(paths, sinks);
  seconds_ += timer.seconds();
  return whole;
}

double RestTracing::paths_beside_pass(const View& view, double pass_seconds, double noise_of_pass) const {
  return std::clamp(plan_.pilot.deviation / noise_of_pass * std::sqrt(pass_seconds / seconds_of_path(view)),
                    kMinBesidePass, kMaxBesidePass);
}

bool RestTracing::trace_all(const View& view, const Sinks& sinks) {
  if (plan_.paths == 0) return true;
  const Timer timer;
  bool whole = true;
  try {
    pathtrace::ReferenceResult rest =
        pathtrace::path_trace(*world_, view, options_, {.spp = plan_.paths}, sinks);
    whole = !rest.interrupted;
    all_ = std::move(rest.image);
    paths_ = rest.spp;
  } catch (const Cancelled&) {
    whole = false;
  }
  seconds_ = timer.seconds();
  return whole;
}

void RestTracing::add_to(image::Image& image) const {
  const image::Image& part = film_ ? film_->result().image : all_;
  for (std::size_t p = 0; p < part.pixels.size(); ++p) image.pixels[p] += part.pixels[p];
}

void RestTracing::add_difference_to(image::Image& image) const {
  if (!film_) return;
  const image::Image difference = film_->halves_difference();
  for (std::size_t p = 0; p < image.pixels.size(); ++p) image.pixels[p] += difference.pixels[p];
}

}  // namespace lumirank::pipeline
