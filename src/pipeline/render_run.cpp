#include "pipeline/render_run.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "base/error.h"
#include "base/random.h"
#include "matrix/metered_matrix.h"
#include "methods/common/timed_choices.h"
#include "pipeline/aovs.h"
#include "pipeline/error_advice.h"
#include "pipeline/illuminance.h"
#include "pipeline/preview_throttle.h"
#include "pipeline/report.h"
#include "pipeline/rest_pilot.h"
#include "pipeline/smaller_film.h"
#include "pipeline/time_pilot.h"
#include "pipeline/time_plan.h"
#include "pipeline/timed_passes.h"

namespace lumirank::pipeline {
namespace {

// Below so many of the pilot's columns for each receiver, columns that all receivers share make a better
// picture than those of slices: the table in docs/decisions.md.
constexpr double kColumnsForSlices = 180;
// At the end of a budget, beyond which more samples of traced parts are not seen.
constexpr int kMostDirect = 1024, kMostRest = 4096;

std::string run_number(const char* format, double x) {
  char text[48];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

class RenderRun {
 public:
  RenderRun(RenderTask task, const RenderSettings& asked, const Sinks& sinks, const PreviewCallback& preview)
      : task_(std::move(task)),
        asked_(asked),
        settings_(asked),
        sinks_(sinks),
        throttle_(preview),
        previews_(static_cast<bool>(preview)),
        clock_([this] { return task_.timer.seconds(); }) {
    setup_.world = task_.world, setup_.view = task_.view;
    setup_.seconds["build"] = task_.build_seconds;
    if (!asked.choices.empty()) choices_ = methods::TimedChoices(asked.choices);
  }

  RenderResult run() {
    sinks_.say("method: " + task_.info->name + " (" + task_.why + ")");
    look_at_rest();
    plan();
    receivers();
    make_matrix(setup_, settings_, lights_, sinks_);
    if (timed()) expect_same_matrix();
    early_rest();
    sums();
    spend_what_is_left();
    if (timed()) record_passes();
    return picture();
  }

 private:
  bool timed() const { return asked_.time > 0; }
  bool replays() const { return !asked_.choices.empty(); }

  // When the film has to begin: half as long again as the pilot found is kept for it.
  double film_begins() const { return kTimeAim * asked_.time - 1.5 * plan_.film_seconds; }
  double share_of_rest(double planned) const { return stage_seconds(planned, film_begins() - clock_()); }

  // ------------------------------------------------------------ before the matrix

  void look_at_rest() {
    const Timer timer;
    rest_plan_ = plan_rest(*setup_.world, setup_.view, asked_, sinks_);
    if (!rest_plan_.piloted) return;
    setup_.seconds["rest_pilot"] = timer.seconds();
    sinks_.say("light that columns cannot carry: " + run_number("%.2g %%", 100 * rest_plan_.pilot.share) +
               (rest_plan_.paths > 0
                    ? ", traced with " + std::to_string(rest_plan_.paths) + " paths per pixel"
                : rest_plan_.pilot.share > RestPilot::kLeast
                    ? ", nearly all of it in one path of the pilot, left out"
                    : ", left out"));
  }

  std::int64_t planned(const char* what, bool given, std::size_t wanted, std::size_t by_plan,
                       std::int64_t most) {
    if (given) {
      choices_.expect(what, static_cast<std::int64_t>(wanted));
      return static_cast<std::int64_t>(wanted);
    }
    const auto earlier = choices_.earlier(what, most);
    const std::int64_t value = earlier ? *earlier : static_cast<std::int64_t>(by_plan);
    choices_.record(what, value);
    return value;
  }

  void plan() {
    lights_ = lights_for(*task_.info, settings_);
    if (!timed()) return;
    const RenderSettings defaults;
    TimeWishes wishes;
    wishes.budget = asked_.time;
    wishes.spp = asked_.spp;
    wishes.spp_given = asked_.spp_given || asked_.spp != defaults.spp;
    wishes.lights = lights_;
    wishes.lights_given = asked_.lights_given || asked_.lights != defaults.lights || lights_ != asked_.lights;
    wishes.rest_paths = rest_plan_.paths;
    wishes.layers = static_cast<int>(asked_.aovs.size());
    wishes.may_be_smaller = asked_.aovs.empty() && is_whole_film(setup_.view);
    if (!replays()) {
      const Timer timer;
      TimeCosts costs = measure_costs(setup_, settings_, sinks_);
      setup_.seconds["pilot"] = timer.seconds();
      const auto film = receiver_settings(setup_.view, settings_);
      costs.pixels = static_cast<double>(film.crop_width) * static_cast<double>(film.crop_height);
      costs.rest = rest_plan_.pilot.path_seconds;
      costs.passed = clock_();
      plan_ = plan_time(wishes, costs);
      if (!plan_.shortage.empty()) sinks_.warn(plan_.shortage);
      sinks_.say(
          "plan: " + std::to_string(plan_.spp) + " receivers per pixel, " + std::to_string(plan_.lights) +
          " virtual lights; " + run_number("%.2g s for traced direct light, ", plan_.direct_seconds) +
          run_number("%.2g s", plan_.rest_seconds) + " at first for the light that columns cannot carry; " +
          run_number("%.3g columns", plan_.columns) + " of the pilot's fit the rest");
    }
    settings_.spp = static_cast<int>(planned("receivers_per_pixel", wishes.spp_given,
                                             static_cast<std::size_t>(wishes.spp),
                                             static_cast<std::size_t>(plan_.spp), 4096));
    lights_ = static_cast<std::size_t>(
        planned("lights_asked", wishes.lights_given, wishes.lights, plan_.lights, 50000000));
    const auto divisor = static_cast<int>(
        planned("film_divisor", !wishes.may_be_smaller, 1, static_cast<std::size_t>(plan_.divisor), 1024));
    if (divisor > 1) {
      // Lights are aimed at what the whole film shows, which the pilot has done already unless this is a
      // repetition.
      setup_.traced_below = traced_roughness(settings_);
      if (!setup_.survey) survey_lights(setup_, settings_, aim_at(setup_, settings_.seed, sinks_));
      setup_.view = smaller(setup_.view, divisor);
    }
    const bool few = planned("few_columns", !task_.by_default, 0,
                             plan_.columns < kColumnsForSlices ? std::size_t{1} : std::size_t{0}, 1) > 0;
    if (few) {
      task_.info = &methods::find_method("row-column-sampling");
      task_.method = task_.info->make({});
      task_.why = "the time holds few columns for each receiver";
      sinks_.say("method: " + task_.info->name + " (" + task_.why + ")");
    }
    choices_.expect("method." + task_.info->name, 1);
  }

  Picture as_asked(const image::Image& image) const {
    Picture picture = to_picture(image);
    if (picture.width == task_.view.width && picture.height == task_.view.height) return picture;
    return enlarged(picture, task_.view.width, task_.view.height);
  }

  void receivers() {
    make_eye_receivers(setup_, settings_, sinks_);
    const Timer timer;
    direct_ = start_direct(setup_, settings_);
    if (direct_) {
      const int usual = TracedDirectSettings{}.samples;
      const auto add = [&](int samples) { return direct_->add(samples, sinks_); };
      const auto earlier = timed() ? choices_.earlier("direct_samples", kMostDirect) : std::nullopt;
      if (!timed() || earlier) {
        if (!add(earlier ? static_cast<int>(*earlier) : usual)) throw Cancelled();
      } else {
        const auto done =
            run_passes({0, 1, usual, clock_() + share_of_rest(plan_.direct_seconds), 0}, clock_, add);
        if (done.cancelled) throw Cancelled();
        direct_pace_ = done.pace;
      }
      keep_direct(setup_, *direct_);
    }
    if (setup_.traced_below > 0) setup_.seconds["traced_direct"] = timer.seconds();
    // With local paths the receivers will have lost their sharp lobes.
    if (!timed() || replays() || asked_.local_paths > 0) direct_.reset();
    trace_sharp_lobes(setup_, settings_, sinks_);
  }

  void expect_same_matrix() {
    choices_.expect("receivers", static_cast<std::int64_t>(setup_.matrix->rows()));
    choices_.expect("virtual_lights", static_cast<std::int64_t>(setup_.matrix->columns()));
  }

  // ------------------------------------------------------------ the method and what is traced around it

  bool add_rest(int paths) {
    return rest_->add(paths, sinks_, [&](double fraction) { sinks_.report("rest", fraction); });
  }

  // Before the method, which fills the budget: some of it must be there.
  void early_rest() {
    if (!timed() || rest_plan_.paths == 0) return;
    const Timer timer;
    rest_ =
        std::make_unique<pathtrace::PathFilm>(*setup_.world, setup_.view, reference_options(asked_, "rest"));
    const auto add = [&](int paths) { return add_rest(paths); };
    if (const auto earlier = choices_.earlier("rest_paths", kMostRest)) {
      if (!add(static_cast<int>(*earlier))) throw Cancelled();
    } else {
      const auto done =
          run_passes({0, 1, rest_plan_.paths, clock_() + share_of_rest(plan_.rest_seconds), 0}, clock_, add);
      if (done.cancelled) throw Cancelled();
      rest_pace_ = done.pace;
    }
    setup_.seconds["rest"] = timer.seconds();
  }

  void sums() {
    methods::RunOptions run;
    run.choices = &choices_;
    run.seed = settings_.method_seed ? settings_.method_seed : settings_.seed;
    run.target_error = settings_.error;
    if (timed())
      run.time_seconds = std::max(1e-3, (film_begins() - clock_()) / passes_over_columns(settings_));
    run.sinks = sinks_;
    if (previews_)
      run.on_estimate = [&](std::span<const Rgb> sums) {
        if (!throttle_.due()) return;
        image::Image image = develop(setup_, sample_values(setup_, sums, wanted_parts(settings_)));
        if (rest_) add_to(image, rest_->result().image);
        throttle_.show(as_asked(image));
      };
    const Timer timer;
    const matrix::MeteredMatrix metered(*setup_.matrix);
    estimate_ = task_.method->run(metered, run);
    cost_ = metered.total();
    setup_.seconds["method"] = timer.seconds();
    result_.interrupted = estimate_.interrupted;
    advise(run.time_seconds);
    if (!wants_illuminance(settings_) || result_.interrupted) return;
    run.on_estimate = {};
    illuminance_ = render_illuminance(setup_, settings_, *task_.method, run, task_.lumens_per_unit);
    result_.interrupted = !illuminance_;
  }

  void advise(double given_seconds) {
    const bool own_lights =
        task_.info->lights_wanted && task_.info->lights_wanted(settings_.method_settings) > 0;
    const ErrorAsked asked{settings_.error, lights_, own_lights ? "--set lights=" : "--lights",
                           task_.info->error_decided_by};
    if (const std::string advice = error_advice(asked, estimate_.trace.numbers); !advice.empty()) {
      sinks_.warn(advice);
      estimate_.trace.notes["error.advice"] = advice;
    }
    if (!timed() || replays() || estimate_.interrupted) return;
    if (const std::string advice =
            budget_advice(asked_.time, given_seconds, plan_.enough, estimate_.trace.numbers);
        !advice.empty())
      sinks_.warn(advice);
  }

  // More samples of what is traced: its noise falls for as long as there is time.
  void spend_what_is_left() {
    if (!timed() || replays() || result_.interrupted) return;
    // Layers by light go over the method's columns again.
    const auto columns = estimate_.trace.numbers.find("seconds.columns");
    const double pass = columns != estimate_.trace.numbers.end() ? columns->second : setup_.seconds["method"];
    const int again = passes_over_columns(settings_) - 1 - (wants_illuminance(settings_) ? 1 : 0);
    const double end = film_begins() - again * pass;
    const auto more_rest = [&](double until) {
      if (!rest_ || result_.interrupted) return;
      const Timer timer;
      const int done = rest_->result().spp;
      const auto passes = run_passes({done, done, kMostRest, until, rest_pace_}, clock_,
                                     [&](int paths) { return add_rest(paths); });
      result_.interrupted = passes.cancelled;
      setup_.seconds["rest"] += timer.seconds();
    };
    if (direct_) {
      more_rest(clock_() + 0.5 * (end - clock_()));
      const Timer timer;
      const int done = direct_->samples();
      const auto passes = result_.interrupted
                              ? PassesDone{done, 0, true}
                              : run_passes({done, done, kMostDirect, end, direct_pace_}, clock_,
                                           [&](int samples) { return direct_->add(samples, sinks_); });
      result_.interrupted = passes.cancelled;
      if (!passes.cancelled && passes.done > done) keep_direct(setup_, *direct_);
      setup_.seconds["traced_direct"] += timer.seconds();
    }
    more_rest(end);
  }

  void record_passes() {
    if (setup_.direct_samples > 0) choices_.record("direct_samples", setup_.direct_samples);
    if (rest_) choices_.record("rest_paths", rest_->result().spp);
    if (!result_.interrupted) choices_.expect_end();
  }

  // ------------------------------------------------------------ the picture

  static void add_to(image::Image& image, const image::Image& part) {
    for (std::size_t p = 0; p < part.pixels.size(); ++p) image.pixels[p] += part.pixels[p];
  }

  // Without a budget the rest is traced last: interrupted, what the matrix gave is kept.
  void late_rest(image::Image& image) {
    if (timed() || rest_plan_.paths == 0 || result_.interrupted) return;
    const Timer timer;
    try {
      const pathtrace::ReferenceResult rest = pathtrace::path_trace(
          *setup_.world, setup_.view, reference_options(asked_, "rest"), {.spp = rest_plan_.paths}, sinks_);
      result_.interrupted = rest.interrupted;
      add_to(image, rest.image);
      rest_paths_ = rest.spp;
    } catch (const Cancelled&) {
      result_.interrupted = true;
    }
    setup_.seconds["rest"] = timer.seconds();
  }

  // Adds what clamping took from indirect light. Interrupted, the picture is without.
  void compensate(image::Image& image) {
    if (settings_.compensate == 0 || result_.interrupted) return;
    const Timer timer;
    pathtrace::ReferenceOptions options = reference_options(settings_, "columns");
    // A reference with the same seed is independent of it.
    options.seed = hash_ids(settings_.seed, Stage::reference, 1);
    options.carried = setup_.carried;
    try {
      const auto traced =
          pathtrace::path_trace(*setup_.world, setup_.view, options, {.spp = settings_.compensate}, sinks_);
      if (traced.interrupted) throw Cancelled();
      add_to(image, traced.indirect);
    } catch (const Cancelled&) {
      result_.interrupted = true;
      return;
    }
    setup_.seconds["compensation"] = timer.seconds();
  }

  RenderResult picture() {
    const Timer film_timer;
    image::Image image = develop(setup_, sample_values(setup_, estimate_.sums, wanted_parts(settings_)));
    const double developed = film_timer.seconds();
    // Emission is in the matrix's picture already; the rest of the paths holds none of its own.
    if (rest_) add_to(image, rest_->result().image), rest_paths_ = rest_->result().spp;
    late_rest(image);
    const Timer layer_timer;
    compensate(image);
    result_.picture = as_asked(image);
    if (!add_aovs(result_.picture, setup_, settings_, estimate_, sinks_)) result_.interrupted = true;
    if (illuminance_)
      result_.picture.planes.push_back({"illuminance", to_picture(*illuminance_).planes[0].rgb});
    else if (wants_illuminance(settings_))
      sinks_.warn("interrupted: the picture has no layer illuminance");
    setup_.seconds["film"] = developed + layer_timer.seconds();
    // An interrupted run cannot be repeated: where it was stopped was no choice of its own.
    if (result_.interrupted) choices_ = {};
    if (rest_plan_.piloted) estimate_.trace.numbers["rest.share"] = rest_plan_.pilot.share;
    estimate_.trace.numbers["rest.paths"] = rest_paths_;
    estimate_.trace.numbers["receivers_per_pixel"] = settings_.spp;
    if (setup_.view.width < task_.view.width)
      estimate_.trace.numbers["film.rendered_part"] =
          static_cast<double>(setup_.view.width) / static_cast<double>(task_.view.width);
    estimate_.trace.notes["method.why"] = task_.why;
    if (!plan_.shortage.empty()) estimate_.trace.notes["budget.short"] = plan_.shortage;
    result_.report_json = make_report(setup_, asked_, *task_.info, estimate_, cost_, choices_.made(),
                                      task_.timer.seconds(), lights_);
    return std::move(result_);
  }

  RenderTask task_;
  const RenderSettings& asked_;
  RenderSettings settings_;  // as planned
  Sinks sinks_;
  PreviewThrottle throttle_;
  bool previews_;
  Clock clock_;
  Setup setup_;
  methods::TimedChoices choices_;
  RestPlan rest_plan_;
  TimePlan plan_;
  std::size_t lights_ = 0;
  std::unique_ptr<DirectTracing> direct_;      // while more samples can be added
  std::unique_ptr<pathtrace::PathFilm> rest_;  // under a budget
  double direct_pace_ = 0, rest_pace_ = 0;
  int rest_paths_ = 0;
  methods::Estimate estimate_;
  matrix::Cost cost_;  // of the method; layers by light go over its columns once more
  std::optional<image::Image> illuminance_;
  RenderResult result_;
};

}  // namespace

RenderResult run_render(RenderTask task, const RenderSettings& settings, const Sinks& sinks,
                        const PreviewCallback& on_preview) {
  return RenderRun(std::move(task), settings, sinks, on_preview).run();
}

}  // namespace lumirank::pipeline
