#include "pipeline/path_run.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "pathtrace/reference.h"
#include "pipeline/develop.h"
#include "pipeline/light_path_pilot.h"
#include "pipeline/noise_metric.h"
#include "pipeline/paths_beside.h"
#include "pipeline/picture_denoising.h"
#include "pipeline/preview_throttle.h"
#include "pipeline/report.h"
#include "pipeline/short_budget.h"
#include "pipeline/smaller_film.h"

namespace lumirank::pipeline {
namespace {

constexpr int kUsualPaths = 64, kMaxPaths = 1 << 20;
// Fewer are no picture where nothing denoises them, and a smaller film is enlarged without features.
constexpr double kFewPaths = 2;
// Before a target for the error is believed.
constexpr int kPathsBeforeError = 16;
constexpr int kMaxPathDivisor = 4;
// Seconds after which a run can be interrupted, or its preview shown.
constexpr double kAtOnce = 0.5;

class PathRun {
 public:
  PathRun(RenderTask task, const RenderSettings& asked, const Sinks& sinks, const PreviewCallback& preview)
      : task_(std::move(task)),
        asked_(asked),
        sinks_(sinks),
        throttle_(preview),
        choices_(asked.choices.empty() ? methods::TimedChoices{} : methods::TimedChoices(asked.choices)),
        denoising_(asked, task_.view, choices_, sinks, task_.denoiser_pixel_seconds),
        view_(denoising_.filtered(task_.view)),
        options_(reference_options(asked.view.only, asked.seed, ReferencePaths::all)) {
    const LightPathPilot light = task_.light_paths ? *task_.light_paths
                                                   : pilot_light_paths(*task_.world, view_, asked.seed,
                                                                       options_.paths, asked.time, sinks);
    options_.light_paths = light.light_paths, options_.aim_light_paths = light.aim;
    if (timed()) choose_light_paths(choices_, "all", options_.light_paths, options_.aim_light_paths);
  }

  RenderResult run() {
    sinks_.say(std::string("method: ") + kByPaths + " (" + task_.why + ")");
    plan();
    film_.emplace(*task_.world, view_, options_);
    bool whole = add(1) && trace_features();
    while (whole && paths() < wanted_) {
      const int more = next();
      if (more < 1) break;
      whole = add(more);
    }
    if (paths() == 0) throw Cancelled();
    result_.interrupted = !whole;
    picture();
    if (!task_.features) refilter(result_.picture, denoising_.lacking_filter());
    report();
    return std::move(result_);
  }

 private:
  bool timed() const { return asked_.time > 0; }
  int paths() const { return film_->paths(); }
  double left() const { return asked_.time - denoising_.seconds() - task_.timer.seconds(); }
  double pixels(const View& view) const {
    return static_cast<double>(view.width) * static_cast<double>(view.height);
  }

  void plan() {
    const int by_hand = asked_.passes > 0 ? asked_.passes : asked_.view.spp.value_or(0);
    wanted_ = by_hand > 0 ? by_hand
              : timed() || asked_.method.target_error > 0
                  ? kMaxPaths
                  : static_cast<int>(std::lround(kUsualPaths * task_.part_of_usual));
    if (!timed()) return;
    if (const auto earlier = choices_.earlier(kChoiceOfPaths, kMaxPaths))
      wanted_ = static_cast<int>(*earlier);
    const int divisor = chosen_divisor();
    choices_.record("film_divisor", divisor);
    if (divisor > 1) view_ = smaller(view_, divisor);
    denoising_.make_smaller(divisor);
  }

  // A film of half the width and height, enlarged, is better than none.
  int chosen_divisor() {
    if (const auto earlier = choices_.earlier("film_divisor", kMaxPathDivisor))
      return static_cast<int>(*earlier);
    const Timer timer;
    const View small = smaller(view_, is_whole_film(view_) ? trial_divisor(view_) : 1);
    pathtrace::PathFilm trial(*task_.world, small, options_);
    if (!trial.add(1, sinks_)) throw Cancelled();
    double path = timer.seconds() * pixels(view_) / pixels(small);  // for each pixel
    seconds_["pilot"] = timer.seconds();
    const double worth = denoising_.wanted() ? paths_worth_a_pixel(view_, options_.light_paths) : kFewPaths;
    const double features = denoising_.seconds_of_feature(*task_.world, small, feature_recipe(), sinks_) *
                            pixels(view_) / pixels(small);
    // With what pilots took; so it is more than the budget wherever fewer fit.
    const double enough = asked_.time - left() + denoising_.feature_seconds(features, left()) + worth * path;
    const auto fit = [&] { return (left() - denoising_.feature_seconds(features, left())) / path; };
    int divisor = 1;
    if (is_whole_film(task_.view) && fit() < worth) {
      // A quarter is better than nothing alone.
      do divisor *= 2, path /= 4, denoising_.make_smaller(divisor);
      while (divisor < kMaxPathDivisor && fit() < 1);
    }
    if (divisor == 1 && fit() >= 1) return divisor;
    shortage_ = said({asked_.time, task_.build_seconds, asked_.time < task_.build_seconds, enough},
                     said_of_smaller(divisor));
    sinks_.warn(shortage_);
    return divisor;
  }

  bool add(int more) {
    const Timer timer;
    const bool whole = film_->add(more, sinks_, [&](double fraction) {
      const double of_all = wanted_ < kMaxPaths ? (paths() + fraction * more) / wanted_
                                                : (task_.timer.seconds() - task_.build_seconds) /
                                                      std::max(1e-3, asked_.time - task_.build_seconds);
      sinks_.report("paths", std::clamp(of_all, 0.0, 1.0));
    });
    seconds_["paths"] += timer.seconds();
    if (whole && throttle_.due()) throttle_.show(sized_for(film_->result().image, task_.view));
    return whole;
  }

  Recipe feature_recipe() const {
    Recipe recipe = make_recipe(asked_, task_.view);
    recipe.seed = hash_ids(asked_.seed, Stage::film_samples);
    return recipe;
  }

  bool trace_features() {
    if (!denoising_.wanted()) return true;
    const Timer timer;
    const bool whole = denoising_.trace_first(*task_.world, denoising_.filtered(task_.view), feature_recipe(),
                                              timed() ? std::max(0.0, left()) : 0, sinks_);
    seconds_["features"] = timer.seconds();
    return whole;
  }

  double noise() const {
    const ErrorMetric metric = asked_.method.error_metric;
    return metric == ErrorMetric::l1 ? film_->result().error
                                     : noise_by(metric, film_->result().image, film_->halves_difference());
  }

  // Paths for each pixel that come next; 0: it is enough.
  int next() {
    if (asked_.method.target_error > 0 && paths() >= ask_error_at_) {
      if (noise() < asked_.method.target_error) return 0;
      ask_error_at_ = static_cast<int>(kPathsToAskAgain * paths());
    }
    const double each = seconds_["paths"] / paths();
    const double at_once = std::clamp(kAtOnce / std::max(each, 1e-9), 1.0, 1.0 * kMaxPaths);
    int more = std::min(wanted_ - paths(), static_cast<int>(at_once));
    if (timed() && wanted_ == kMaxPaths) more = std::min(more, paths_that_fit(left(), each, asked_.time));
    return more;
  }

  void picture() {
    if (timed() && !result_.interrupted) choices_.record(kChoiceOfPaths, paths());
    if (result_.interrupted) choices_ = {};
    result_.picture = sized_for(film_->result().image, task_.view);
    if (result_.interrupted) return;
    // What is seen straight comes by features: always of a larger film, else where these have less noise.
    const bool smaller = view_.width < task_.view.width;
    const bool apart =
        options_.emission && denoising_.traced() &&
        (smaller || (paths() > 1 && own_emission_over_apart(film_->result().image, film_->halves_difference(),
                                                            film_->sent_difference(), paths(), paths()) > 1));
    const Timer timer;
    image::Image traced = without_fireflies(*film_, options_.emission && !apart);
    if (apart) image::add_to(traced, denoising_.noisy_emission(traced));
    const image::Image difference = paths() < PictureDenoising::kPathsForNoise ? image::Image{}
                                    : apart                                    ? film_->sent_difference()
                                                                               : film_->halves_difference();
    if (task_.features && denoising_.traced())
      *task_.features = {denoising_.features(),
                         apart ? denoising_.with_emission_as_noise(difference) : difference,
                         denoising_.lacking_filter()};
    const SampledNoise noise{difference, film_->sent_deviation(), apart, apart || !options_.emission};
    if (const auto denoised = denoising_.denoised(traced, noise, left())) {
      std::vector<float> before = std::move(result_.picture.planes[0].rgb);
      image::Image whole = denoising_.enlarged(denoised->picture);
      if (apart) image::add_to(whole, denoising_.features().emission);
      result_.picture = to_picture(whole);
      denoiser_kept_ = denoised->kept;
      result_.picture.planes.push_back({"undenoised", std::move(before)});
      seconds_["denoise"] = timer.seconds();
    }
  }

  void report() {
    Report& report = result_.report = begin_report(kByPaths, asked_);
    report.notes["method.why"] = task_.why;
    denoising_.note(seconds_.contains("denoise"), report.notes);
    if (seconds_.contains("denoise")) report.numbers["denoise.kept"] = denoiser_kept_;
    if (!shortage_.empty()) report.notes["budget.short"] = shortage_;
    report.numbers["spp"] = paths();
    report.numbers["paths.light_paths"] = options_.light_paths;
    report.numbers["paths.light_paths_aimed"] = options_.aim_light_paths ? 1 : 0;
    if (paths() > 1) {
      report.numbers["error.noise"] = film_->result().error;
      report.numbers["error.estimate"] = noise();
      report.notes["error.of"] = said_of_noise(asked_.method.error_metric, "paths");
    }
    if (view_.width < task_.view.width)
      report.numbers["film.rendered_part"] =
          static_cast<double>(view_.width) / static_cast<double>(task_.view.width);
    report.choices = choices_.made();
    report.memory.peak = peak_memory_bytes();
    report.memory.scene = task_.world->info().memory_bytes;
    seconds_["build"] = task_.build_seconds;
    seconds_["total"] = task_.timer.seconds();
    report.seconds = seconds_;
  }

  RenderTask task_;
  const RenderSettings& asked_;
  Sinks sinks_;
  PreviewThrottle throttle_;
  methods::TimedChoices choices_;
  PictureDenoising denoising_;
  View view_;
  pathtrace::ReferenceOptions options_;
  std::optional<pathtrace::PathFilm> film_;
  double denoiser_kept_ = 0;              // Shrunk::kept
  int wanted_ = kUsualPaths;              // paths per pixel
  int ask_error_at_ = kPathsBeforeError;  // paths per pixel
  std::string shortage_;
  std::map<std::string, double> seconds_;
  RenderResult result_;
};

}  // namespace

bool may_be_paths(const RenderSettings& settings) {
  return settings.method.name == "auto" && settings.method.parameters.empty() && settings.layers.empty() &&
         !settings.view.is_open() && !settings.view.film_samples && !settings.lights.count &&
         settings.lights.type == LightType::point && settings.traced.compensate == 0 &&
         settings.traced.local_paths == 0;
}

bool paths_by_default(const scenedesc::SceneDesc& desc, const RenderSettings& settings) {
  return !desc.media.empty() && may_be_paths(settings);
}

RenderResult run_by_paths(RenderTask task, const RenderSettings& settings, const Sinks& sinks,
                          const PreviewCallback& on_preview) {
  return PathRun(std::move(task), settings, sinks, on_preview).run();
}

}  // namespace lumirank::pipeline
