#include "pipeline/exposure_run.h"

#include <algorithm>

#include "base/error.h"
#include "matrix/metered_matrix.h"
#include "pipeline/develop.h"
#include "pipeline/error_advice.h"
#include "pipeline/preview_throttle.h"
#include "pipeline/report.h"
#include "pipeline/rest_pilot.h"

namespace lumirank::pipeline {
namespace {

class ExposureRun {
 public:
  ExposureRun(const std::vector<Instant>& instants, RenderTask task, const RenderSettings& asked,
              const Sinks& sinks, const PreviewCallback& preview)
      : instants_(instants),
        task_(std::move(task)),
        asked_(asked),
        sinks_(sinks),
        throttle_(preview),
        previews_(static_cast<bool>(preview)) {}

  RenderResult run() {
    sinks_.say("method: " + task_.info->name + " (" + task_.why + "), " + std::to_string(instants_.size()) +
               " instants");
    plan_rest_of_light();
    Timer timer;
    lights_ = lights_for(*task_.info, asked_);
    exposure_ = prepare_exposure(instants_, make_recipe(asked_, instants_.front().view), lights_, sinks_);
    film_ = exposure_.film();
    seconds_["instants"] = timer.seconds();
    sums();
    timer = {};
    trace_rest_of_light();
    result_.picture = to_picture(image_of(estimate_.sums));
    seconds_["film"] = timer.seconds() - seconds_["rest"];
    report();
    return std::move(result_);
  }

 private:
  // Light that columns cannot carry may be there at some instants only.
  void plan_rest_of_light() {
    const Timer timer;
    for (const std::size_t k : {std::size_t{0}, instants_.size() / 2, instants_.size() - 1}) {
      const RestPlan plan =
          plan_rest(*instants_[k].world, instants_[k].view, asked_, LightPaths::none, sinks_);
      if (k == 0 || plan.pilot.share > rest_.pilot.share) rest_ = plan;
      if (!plan.piloted) break;
    }
    if (rest_.piloted) seconds_["rest_pilot"] = timer.seconds();
  }

  void trace_rest_of_light() {
    if (rest_.paths == 0 || result_.interrupted) return;
    const Timer timer;
    try {
      const auto options = reference_options(asked_.view.only, asked_.seed, ReferencePaths::rest);
      auto traced = pathtrace::path_trace(instants_, options, {.spp = rest_.paths}, sinks_);
      result_.interrupted = traced.interrupted;
      rest_image_ = std::move(traced.image);
      rest_paths_ = traced.spp;
    } catch (const Cancelled&) {
      result_.interrupted = true;
    }
    seconds_["rest"] = timer.seconds();
  }

  image::Image image_of(std::span<const Rgb> sums) const {
    const View& view = instants_.front().view;
    image::Image image =
        film::splat(view.width, view.height, world::make_filter(view.sensor.film.filter), film_,
                    exposure_.values(sums, asked_.view.only), {view.crop_x, view.crop_y});
    for (std::size_t p = 0; p < rest_image_.pixels.size(); ++p) image.pixels[p] += rest_image_.pixels[p];
    return image;
  }

  void sums() {
    methods::RunOptions run;
    run.seed = asked_.method.seed ? asked_.method.seed : asked_.seed;
    run.target_error = asked_.method.target_error;
    run.sinks = sinks_;
    if (previews_)
      run.on_estimate = [&](std::span<const Rgb> sums) {
        if (throttle_.due()) throttle_.show(to_picture(image_of(sums)));
      };
    const Timer timer;
    const matrix::MeteredMatrix metered(*exposure_.matrix);
    estimate_ = task_.method->run(metered, run);
    cost_ = metered.total();
    seconds_["method"] = timer.seconds();
    result_.interrupted = estimate_.interrupted;
    const ErrorAsked asked{asked_.method.target_error, lights_, "--lights", task_.info->error_parameters};
    if (const std::string advice = error_advice(asked, estimate_.trace.numbers); !advice.empty()) {
      sinks_.warn(advice);
      estimate_.trace.notes["error.advice"] = advice;
    }
  }

  void report() {
    auto& numbers = estimate_.trace.numbers;
    if (rest_.piloted) numbers["rest.share"] = rest_.pilot.share;
    numbers["rest.paths"] = rest_paths_;
    numbers["receivers_per_pixel"] = asked_.view.spp_or_default();
    numbers["shutter.instants"] = static_cast<double>(instants_.size());
    // Of the whole matrix, but for the blocks of different instants, which nobody has to look at.
    double entries = 0;
    for (const SharedPrepared& now : exposure_.instants)
      entries += static_cast<double>(now->matrix->rows()) * static_cast<double>(now->matrix->columns());
    numbers["sampling_rate"] = entries > 0 ? static_cast<double>(cost_.entries) / entries : 1.0;
    estimate_.trace.notes["method.why"] = task_.why;
    const Prepared& first = *exposure_.instants.front();
    Report& report = result_.report;
    report = make_report(first, first.traced, asked_, *task_.info, estimate_, cost_, {});
    report.sizes->lights_asked = lights_;
    for (std::size_t k = 1; k < exposure_.instants.size(); ++k) {
      const Prepared& now = *exposure_.instants[k];
      report.sizes->receivers += now.receivers().size(), report.sizes->lights += now.lights().size();
      report.sizes->direct_lights += now.lights().direct_count,
          report.sizes->light_paths += now.lights().paths;
      if (now.world != exposure_.instants[k - 1]->world)
        report.memory.scene += now.world->info().memory_bytes;
      report.memory.receivers += now.receivers().memory_bytes();
      report.memory.lights += now.lights().memory_bytes(), report.memory.matrix += now.matrix->memory_bytes();
    }
    seconds_["build"] = task_.build_seconds;
    seconds_["total"] = task_.timer.seconds();
    report.seconds = seconds_;
  }

  const std::vector<Instant>& instants_;
  RenderTask task_;
  const RenderSettings& asked_;
  Sinks sinks_;
  PreviewThrottle throttle_;
  bool previews_;
  std::size_t lights_ = 0;
  RestPlan rest_;
  image::Image rest_image_;
  int rest_paths_ = 0;
  Exposure exposure_;
  std::vector<Vec2f> film_;
  methods::Estimate estimate_;
  matrix::Cost cost_;
  std::map<std::string, double> seconds_;
  RenderResult result_;
};

}  // namespace

RenderResult run_exposure(const std::vector<Instant>& instants, RenderTask task,
                          const RenderSettings& settings, const Sinks& sinks,
                          const PreviewCallback& on_preview) {
  return ExposureRun(instants, std::move(task), settings, sinks, on_preview).run();
}

}  // namespace lumirank::pipeline
