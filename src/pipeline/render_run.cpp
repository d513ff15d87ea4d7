#include "pipeline/render_run.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "base/error.h"
#include "matrix/metered_matrix.h"
#include "methods/common/timed_choices.h"
#include "pipeline/compensation.h"
#include "pipeline/develop.h"
#include "pipeline/error_advice.h"
#include "pipeline/illuminance.h"
#include "pipeline/layers.h"
#include "pipeline/preview_throttle.h"
#include "pipeline/report.h"
#include "pipeline/rest_tracing.h"
#include "pipeline/smaller_film.h"
#include "pipeline/time_pilot.h"
#include "pipeline/time_plan.h"
#include "pipeline/timed_passes.h"
#include "pipeline/traced_indirect.h"

namespace lumirank::pipeline {
namespace {

// Below so many of the pilot's columns for each receiver, columns that all receivers share make a better
// picture than those of slices: the table in docs/decisions.md.
constexpr double kColumnsForSlices = 180;
// At the end of a budget, beyond which more samples of traced parts are not seen.
constexpr int kMaxDirectSamples = 1024;

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
        sinks_(sinks),
        throttle_(preview),
        previews_(static_cast<bool>(preview)),
        clock_([this] { return task_.timer.seconds(); }),
        view_(task_.view),
        recipe_(make_recipe(asked, view_)),
        parts_(wanted_parts(asked.view.only)) {
    recipe_.shot_lights = task_.shot_lights;
    seconds_["build"] = task_.build_seconds;
    if (!asked.choices.empty()) choices_ = methods::TimedChoices(asked.choices);
  }

  RenderResult run() {
    sinks_.say("method: " + task_.info->name + " (" + task_.why + ")");
    rest_.emplace(task_.world, view_, asked_, sinks_);
    if (rest_->plan().piloted) seconds_["rest_pilot"] = rest_->pilot_seconds();
    plan();
    rows();
    columns();
    if (timed()) {
      expect_same_matrix();
      early_rest();
    }
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

  // Before the method, which fills the budget: some of it must be there.
  void early_rest() {
    if (rest_->plan().paths == 0) return;
    const auto earlier = choices_.earlier("rest_paths", RestTracing::kMaxPaths);
    rest_->begin(view_, earlier ? static_cast<int>(*earlier) : 0,
                 clock_() + share_of_rest(plan_.rest_seconds), clock_, sinks_);
  }

  // ------------------------------------------------------------ the plan

  std::int64_t planned(const char* what, bool given, std::size_t wanted, std::size_t by_plan,
                       std::int64_t max_value) {
    if (given) {
      choices_.expect(what, static_cast<std::int64_t>(wanted));
      return static_cast<std::int64_t>(wanted);
    }
    const auto earlier = choices_.earlier(what, max_value);
    const std::int64_t value = earlier ? *earlier : static_cast<std::int64_t>(by_plan);
    choices_.record(what, value);
    return value;
  }

  TimeWishes wishes() const {
    TimeWishes wishes;
    wishes.budget = asked_.time;
    wishes.spp = recipe_.spp;
    wishes.spp_given = asked_.view.spp.has_value();
    wishes.film_samples = recipe_.film_samples;
    wishes.film_samples_given = asked_.view.film_samples || recipe_.film_samples == 0;
    wishes.lights = lights_;
    wishes.lights_given = asked_.lights.count || lights_ != asked_.lights.count_or_default();
    wishes.rest_paths = rest_->plan().paths;
    wishes.layers = static_cast<int>(asked_.layers.size());
    wishes.may_be_smaller = asked_.layers.empty() && is_whole_film(view_);
    return wishes;
  }

  void measure(const TimeWishes& wishes) {
    const Timer timer;
    TimePilot pilot = measure_costs(task_.world, view_, recipe_, sinks_);
    survey_ = std::move(pilot.survey);
    seconds_["pilot"] = timer.seconds();
    TimeCosts& costs = pilot.costs;
    const auto film = receiver_settings(recipe_, view_);
    costs.pixels = static_cast<double>(film.crop_width) * static_cast<double>(film.crop_height);
    costs.rest = rest_->plan().pilot.path_seconds;
    costs.passed = clock_();
    plan_ = plan_time(wishes, costs);
    if (!plan_.shortage.empty()) sinks_.warn(plan_.shortage);
    sinks_.say("plan: " + std::to_string(plan_.spp) + " receivers and " + std::to_string(plan_.film_samples) +
               " film samples per pixel, " + std::to_string(plan_.lights) + " virtual lights; " +
               run_number("%.2g s for traced direct light, ", plan_.direct_seconds) +
               run_number("%.2g s", plan_.rest_seconds) +
               " at first for the light that columns cannot carry; " +
               run_number("%.3g columns", plan_.columns) + " of the pilot's fit the rest");
  }

  void plan() {
    lights_ = lights_for(*task_.info, asked_);
    if (!timed()) return;
    const TimeWishes wishes = this->wishes();
    if (!replays()) measure(wishes);
    recipe_.spp = static_cast<int>(planned("receivers_per_pixel", wishes.spp_given,
                                           static_cast<std::size_t>(wishes.spp),
                                           static_cast<std::size_t>(plan_.spp), 4096));
    recipe_.film_samples = static_cast<int>(planned("film_samples", wishes.film_samples_given,
                                                    static_cast<std::size_t>(wishes.film_samples),
                                                    static_cast<std::size_t>(plan_.film_samples), 4096));
    lights_ = static_cast<std::size_t>(
        planned("lights_asked", wishes.lights_given, wishes.lights, plan_.lights, 50000000));
    const auto divisor = static_cast<int>(
        planned("film_divisor", !wishes.may_be_smaller, 1, static_cast<std::size_t>(plan_.divisor), 1024));
    if (divisor > 1) {
      // Lights are aimed at what the whole film shows, which the pilot has done already unless this is a
      // repetition.
      if (!survey_) make_survey();
      view_ = smaller(view_, divisor);
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

  void make_survey() { survey_ = survey(task_.world, view_, recipe_, sinks_); }

  // ------------------------------------------------------------ rows, columns, matrix

  void keep_direct() {
    traced_.direct = direct_->radiance();
    traced_.direct_samples = direct_->samples();
  }

  void rows() {
    const world::World& world = *task_.world;
    Timer timer;
    direct_rows_ = trace_rows(world, view_, recipe_, sinks_);
    seconds_["receivers"] = timer.seconds();
    timer = {};
    direct_ = start_direct(world, *direct_rows_, recipe_);
    if (direct_) {
      const int usual = TracedDirectSettings{}.samples;
      const auto add = [&](int samples) { return direct_->add(samples, sinks_); };
      const auto earlier = timed() ? choices_.earlier("direct_samples", kMaxDirectSamples) : std::nullopt;
      if (!timed() || earlier) {
        if (!add(earlier ? static_cast<int>(*earlier) : usual)) throw Cancelled();
      } else {
        const auto done =
            run_passes({0, 1, usual, clock_() + share_of_rest(plan_.direct_seconds), 0}, clock_, add);
        if (done.cancelled) throw Cancelled();
        direct_pace_ = done.pace;
      }
      keep_direct();
    }
    if (recipe_.traced_below > 0) seconds_["traced_direct"] = timer.seconds();
    timer = {};
    traced_.rows = direct_rows_;
    traced_.sharp = trace_sharp_lobes(world, *direct_rows_, recipe_, sinks_);
    rows_ = matrix_rows(direct_rows_, recipe_);
    if (rows_ != direct_rows_) seconds_["traced_indirect"] = timer.seconds();
    // With local paths the time is not planned.
    if (!timed() || replays() || asked_.traced.local_paths > 0) direct_.reset(), direct_rows_.reset();
  }

  void columns() {
    const world::World& world = *task_.world;
    Timer timer;
    if (!survey_) make_survey();
    const SharedSurvey survey = std::move(survey_);
    Columns columns = trace_columns(world, recipe_, *survey, lights_, sinks_);
    seconds_["lights"] = timer.seconds();
    timer = {};
    traced_.near = trace_near(world, *rows_, columns, recipe_, sinks_);
    if (!traced_.near.empty()) seconds_["traced_near"] = timer.seconds();
    prepared_ = join(task_.world, view_, recipe_, rows_, std::move(columns), {}, {});
    seconds_["matrix"] = prepared_->seconds.at("matrix");
  }

  void expect_same_matrix() {
    choices_.expect("receivers", static_cast<std::int64_t>(prepared_->matrix->rows()));
    choices_.expect("virtual_lights", static_cast<std::int64_t>(prepared_->matrix->columns()));
  }

  // ------------------------------------------------------------ the method and what is traced around it

  // A preview shows receivers alone, which takes no time.
  image::Image image_of(std::span<const Rgb> sums, bool preview) {
    const FilmInput film{*task_.world, view_, recipe_, *rows_, traced_};
    image::Image image = preview ? develop(view_, *rows_, sample_values(*rows_, traced_, sums, parts_))
                                 : develop(film, sums, parts_, &fits_);
    // Emission is in the matrix's picture already; the rest of the paths holds none of its own.
    rest_->add_to(image);
    return image;
  }

  void sums() {
    methods::RunOptions run;
    run.choices = &choices_;
    run.seed = asked_.method.seed ? asked_.method.seed : asked_.seed;
    run.target_error = asked_.method.target_error;
    if (timed()) run.time_seconds = std::max(1e-3, (film_begins() - clock_()) / passes_over_columns(asked_));
    run.sinks = sinks_;
    if (previews_)
      run.on_estimate = [&](std::span<const Rgb> sums) {
        if (throttle_.due()) throttle_.show(sized_for(image_of(sums, true), task_.view));
      };
    Timer timer;
    const matrix::MeteredMatrix metered(*prepared_->matrix);
    estimate_ = task_.method->run(metered, run);
    cost_ = metered.total();
    seconds_["method"] = timer.seconds();
    result_.interrupted = estimate_.interrupted;
    advise(run.time_seconds);
    if (!wants_illuminance(asked_) || result_.interrupted) return;
    run.on_estimate = {};
    timer = {};
    illuminance_ = render_illuminance(*prepared_, *task_.method, run, task_.lumens_per_unit);
    if (illuminance_) seconds_["illuminance"] = timer.seconds();
    result_.interrupted = !illuminance_;
  }

  void advise(double given_seconds) {
    const bool own_lights =
        task_.info->lights_wanted && task_.info->lights_wanted(asked_.method.parameters) > 0;
    const ErrorAsked asked{asked_.method.target_error, lights_, own_lights ? "--set lights=" : "--lights",
                           task_.info->error_parameters};
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
    const double pass = columns != estimate_.trace.numbers.end() ? columns->second : seconds_["method"];
    const int again = passes_over_columns(asked_) - 1 - (wants_illuminance(asked_) ? 1 : 0);
    const double end = film_begins() - again * pass;
    const auto more_rest = [&](double until) {
      if (!result_.interrupted) result_.interrupted = !rest_->add_until(until, clock_, sinks_);
    };
    if (direct_) {
      more_rest(clock_() + 0.5 * (end - clock_()));
      more_direct(end);
    }
    more_rest(end);
  }

  void more_direct(double until) {
    if (result_.interrupted) return;
    const Timer timer;
    const int done = direct_->samples();
    const auto passes = run_passes({done, done, kMaxDirectSamples, until, direct_pace_}, clock_,
                                   [&](int samples) { return direct_->add(samples, sinks_); });
    result_.interrupted = passes.cancelled;
    if (!passes.cancelled && passes.done > done) keep_direct();
    seconds_["traced_direct"] += timer.seconds();
  }

  void record_passes() {
    if (traced_.direct_samples > 0) choices_.record("direct_samples", traced_.direct_samples);
    if (rest_->begun()) choices_.record("rest_paths", rest_->paths());
    if (!result_.interrupted) choices_.expect_end();
  }

  // ------------------------------------------------------------ the picture

  // Adds what clamping took from indirect light. Interrupted, the picture is without.
  void compensate(image::Image& image) {
    if (asked_.traced.compensate == 0 || result_.interrupted) return;
    const Timer timer;
    result_.interrupted = !compensate_clamping(*prepared_, asked_, image, sinks_);
    if (!result_.interrupted) seconds_["compensation"] = timer.seconds();
  }

  void layers() {
    if (!add_layers(result_.picture, *prepared_, traced_, estimate_, asked_.layers, sinks_))
      result_.interrupted = true;
    if (illuminance_)
      result_.picture.planes.push_back({"illuminance", to_picture(*illuminance_).planes[0].rgb});
    else if (wants_illuminance(asked_))
      sinks_.warn("interrupted: the picture has no layer illuminance");
  }

  RenderResult picture() {
    const Timer film_timer;
    // Without a budget the rest is traced last: interrupted, what the matrix gave is kept.
    if (!timed() && !result_.interrupted) result_.interrupted = !rest_->trace_all(view_, sinks_);
    if (rest_->seconds() > 0) seconds_["rest"] = rest_->seconds();
    image::Image image = image_of(estimate_.sums, false);
    compensate(image);
    result_.picture = sized_for(image, task_.view);
    layers();
    seconds_["film"] = film_timer.seconds() - (timed() ? 0 : rest_->seconds());
    report();
    return std::move(result_);
  }

  void report() {
    auto& numbers = estimate_.trace.numbers;
    // An interrupted run cannot be repeated: where it was stopped was no choice of its own.
    if (result_.interrupted) choices_ = {};
    if (rest_->plan().piloted) numbers["rest.share"] = rest_->plan().pilot.share;
    numbers["rest.paths"] = rest_->paths();
    numbers["receivers_per_pixel"] = recipe_.spp;
    add_film_numbers(numbers, recipe_, *traced_.rows, fits_);
    if (view_.width < task_.view.width)
      numbers["film.rendered_part"] =
          static_cast<double>(view_.width) / static_cast<double>(task_.view.width);
    estimate_.trace.notes["method.why"] = task_.why;
    if (!plan_.shortage.empty()) estimate_.trace.notes["budget.short"] = plan_.shortage;
    result_.report = make_report(*prepared_, traced_, asked_, *task_.info, estimate_, cost_, choices_.made());
    seconds_["total"] = task_.timer.seconds();
    result_.report.seconds = seconds_;
  }

  RenderTask task_;
  const RenderSettings& asked_;
  Sinks sinks_;
  PreviewThrottle throttle_;
  bool previews_;
  Clock clock_;
  View view_;      // as planned
  Recipe recipe_;  // likewise
  FilmParts parts_;
  methods::TimedChoices choices_;
  std::optional<RestTracing> rest_;
  TimePlan plan_;
  std::size_t lights_ = 0;
  SharedSurvey survey_;  // of the pilot, until it is used
  SharedRows rows_;
  TracedLight traced_;
  FilmFits fits_;
  SharedRows direct_rows_;                 // and the light traced at them,
  std::unique_ptr<DirectTracing> direct_;  // while more samples can be added
  double direct_pace_ = 0;
  SharedPrepared prepared_;
  methods::Estimate estimate_;
  matrix::Cost cost_;  // of the method; layers by light go over its columns once more
  std::optional<image::Image> illuminance_;
  std::map<std::string, double> seconds_;
  RenderResult result_;
};

}  // namespace

RenderResult run_render(RenderTask task, const RenderSettings& settings, const Sinks& sinks,
                        const PreviewCallback& on_preview) {
  return RenderRun(std::move(task), settings, sinks, on_preview).run();
}

}  // namespace lumirank::pipeline
