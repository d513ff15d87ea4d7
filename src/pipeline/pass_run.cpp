#include "pipeline/pass_run.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/random.h"
#include "methods/common/timed_choices.h"
#include "pipeline/develop.h"
#include "pipeline/layers.h"
#include "pipeline/media_run.h"
#include "pipeline/mixed_picture.h"
#include "pipeline/noise_metric.h"
#include "pipeline/pass_picture.h"
#include "pipeline/pass_pilot.h"
#include "pipeline/pass_plan.h"
#include "pipeline/pass_tracer.h"
#include "pipeline/path_run.h"
#include "pipeline/paths_after_passes.h"
#include "pipeline/preview_throttle.h"
#include "pipeline/report.h"
#include "pipeline/rest_tracing.h"
#include "pipeline/smaller_film.h"

namespace lumirank::pipeline {
namespace {

constexpr int kDefaultPasses = 16;
// Paths of the rest for each pass without a budget.
constexpr double kRestUntimed = 2;
// Of the passes that fit, those after which paths are tried.
constexpr double kPartBeforePaths = 0.1;
constexpr int kMaxBeforePaths = 8;
// Paths go alone where the rest is more of the light than this.
constexpr double kRestForPaths = 0.2;
// What of all that is done for a pixel draws of lights are, before it is known.
constexpr double kDrawingShare = 0.5;

class PassRun {
 public:
  PassRun(RenderTask task, const RenderSettings& asked, const Sinks& sinks, const PreviewCallback& preview)
      : task_(std::move(task)),
        asked_(asked),
        sinks_(sinks),
        preview_(preview),
        throttle_(preview),
        previews_(static_cast<bool>(preview)),
        clock_([this] { return task_.timer.seconds(); }),
        view_(task_.view),
        tracer_(task_.world, *task_.info, std::move(task_.method), asked, sinks, seconds_) {
    seconds_["build"] = task_.build_seconds;
    if (!asked.choices.empty()) choices_ = methods::TimedChoices(asked.choices);
  }

  RenderResult run() {
    sinks_.say("method: " + task_.info->name + " (" + task_.why + ")");
    passes_.emplace(asked_, view_, choices_, sinks_);
    view_ = passes_->denoising().filtered(view_);
    rest_.emplace(task_.world, view_, asked_, sinks_);
    if (rest_->plan().piloted) seconds_["rest_pilot"] = rest_->pilot_seconds();
    if (rest_is_most()) return by_paths_alone("columns cannot carry much of its light");
    if (timed() && asked_.traced.rest != RestOfPaths::skip) rest_->choose(choices_);
    const Timer survey_timer;
    tracer_.aim(survey(task_.world, view_, tracer_.recipe_of(0, view_), sinks_));
    seconds_["survey"] = survey_timer.seconds();
    plan();
    if (pilot_->paths_alone())
      return by_paths_alone("few passes would fit, and on a small film paths had less noise");
    if (!trace_features()) throw Cancelled();
    picture_.emplace(*passes_, *rest_);
    while (wants_more()) {
      set_size();
      if (!pass(done_)) break;
      ++done_;
      if (done_ == kPassesBeforePaths * tracer_.parts()) choose_when_to_compare();
      if (done_ == before_paths_ * tracer_.parts() && !compare_with_paths()) break;
    }
    if (rounds() == 0) throw Cancelled();
    return result();
  }

 private:
  bool timed() const { return asked_.time > 0; }
  bool replays() const { return !asked_.choices.empty(); }

  // Each shows every pixel once.
  int rounds() const { return done_ / tracer_.parts(); }

  // What takes longer the larger a pass is.
  double seconds_drawing() { return seconds_["method"] + seconds_["lights"]; }

  bool rest_is_most() const {
    if (replays()) return asked_.choices.contains(kChoiceOfPaths);
    // Where paths from the lamps are worth their time, these are hard to find from the eye, and through glass
    // no path finds what they have lit: then passes come first, and show what paths would miss.
    return task_.may_be_paths && rest_->plan().piloted && rest_->plan().light_paths == 0 &&
           rest_->plan().pilot.share > kRestForPaths;
  }
  RenderResult by_paths_alone(const char* why) {
    task_.why = why;
    task_.denoiser_pixel_seconds = passes_->denoising().pixel_seconds();
    if (pilot_) task_.light_paths = pilot_->light_paths();
    RenderSettings settings = asked_;
    // What no clock decided is decided again where the report is repeated.
    if (!timed()) settings.method.name = "auto";
    return run_by_paths(std::move(task_), settings, sinks_, preview_);
  }

  // ------------------------------------------------------------ how many

  void plan() {
    const int by_hand = asked_.passes > 0 ? asked_.passes : asked_.view.spp.value_or(0);
    as_asked_ = by_hand > 0;
    pilot_.emplace(task_, view_, asked_, tracer_, *passes_, *rest_, choices_, seconds_, sinks_);
    if (timed()) {
      replays() ? pilot_->repeat() : pilot_->run();
      if (pilot_->paths_alone()) return;
      view_ = pilot_->view();
    }
    wanted_ = as_asked_ ? by_hand
              : timed() || asked_.method.target_error > 0
                  ? kMaxPasses
                  : static_cast<int>(std::lround(kDefaultPasses * task_.part_of_usual));
    if (timed()) {
      if (const auto earlier = choices_.earlier("passes", kMaxPasses)) wanted_ = static_cast<int>(*earlier);
    }
    plan_ = PassPlan(pilot_->resizes(), tracer_.parts());
    const double with_rest = pilot_->with_rest();
    const double by_pixel = with_rest * pilot_->expected().by_pixel / tracer_.parts();
    const double fixed = with_rest * pilot_->expected().fixed / std::sqrt(tracer_.parts());
    plan_.expect((1 - kDrawingShare) * by_pixel, (fixed + kDrawingShare * by_pixel) / PassPlan::kWhole);
  }

  Recipe film_recipe(int number) const {
    Recipe recipe = tracer_.recipe_of(static_cast<std::uint64_t>(number), view_);
    recipe.seed = hash_ids(asked_.seed, Stage::film_samples, recipe.pass);
    return recipe;
  }
  // Before any pass, since what edges take is not known until they are found: passes are planned for what is
  // left.
  bool trace_features() {
    const Timer timer;
    Recipe recipe = film_recipe(0);
    recipe.pixels = {};
    const bool whole = passes_->begin(*task_.world, recipe, timed() ? left() : 0, sinks_);
    seconds_["features"] += timer.seconds();
    return whole;
  }

  void set_size() {
    int eighths = next_eighths_;
    if (timed()) {
      if (const auto earlier = choices_.earlier("eighths_of_pass", PassPlan::kMax))
        eighths = static_cast<int>(*earlier);
      choices_.record("eighths_of_pass", eighths);
    }
    tracer_.set_size(eighths);
  }

  double left() const { return asked_.time - passes_->denoising().seconds() - clock_(); }

  bool wants_more() {
    if (picture_->by_paths()) return false;
    next_eighths_ = timed() && !as_asked_ ? plan_.next(left()) : PassPlan::kWhole;
    if (sinks_.cancelled()) return false;
    if (done_ >= wanted_) return false;
    if (rounds() == 0) return true;
    const double target = asked_.method.target_error;
    if (target > 0 && rounds() >= kFewPasses && picture_->noise(asked_.method.error_metric) < target)
      return false;
    return !timed() || replays() || as_asked_ || next_eighths_ > 0;
  }

  bool pass(int number) {
    const double begin = clock_(), drawn_before = seconds_drawing();
    image::Image image;
    PassSeconds took;
    if (!tracer_.trace(static_cast<std::uint64_t>(number), view_, image, took)) return false;
    if (!add_rest(took.total())) return false;
    passes_seconds_ += clock_() - begin;
    plan_.took(tracer_.eighths(), clock_() - begin, seconds_drawing() - drawn_before);
    Recipe of_film = film_recipe(number);
    // A pass has as many samples as its size.
    const double weight = static_cast<double>(tracer_.eighths()) / PassPlan::kWhole;
    const PassPicture::Pass shown{number / tracer_.parts(), wanted_, weight,
                                  of_film.pixels.in_window(view_.crop_x, view_.crop_y),
                                  number % tracer_.parts() == 0};
    of_film.pixels = {};
    const Timer timer;
    if (!passes_->add(shown, image,
                      {*task_.world, view_, of_film, *tracer_.prepared()->rows, tracer_.traced()}, sinks_))
      return false;
    seconds_["features"] += timer.seconds();
    report_progress(number + 1);
    if (number + 1 >= tracer_.parts()) show_preview();
    return true;
  }

  void report_progress(int passes) const {
    const double part = timed() ? (clock_() - task_.build_seconds) / (asked_.time - task_.build_seconds)
                                : static_cast<double>(passes) / wanted_;
    sinks_.report("passes", std::clamp(part, 0.0, 1.0));
  }
  void show_preview() {
    if (previews_ && throttle_.due())
      throttle_.show(sized_for(picture_->complete(picture_->with_all_noise()), task_.view));
  }

  double rest_per_pass(double pass_seconds) const {
    if (!timed() || !(rest_->seconds_of_path(view_) > 0)) return kRestUntimed;
    const double of_pass = rounds() >= kFewPasses ? passes_->noise() * std::sqrt(rounds()) : kNoiseOfPass;
    return rest_->paths_beside_pass(view_, pass_seconds, of_pass);
  }
  bool add_rest(double pass_seconds) {
    if (rest_->plan().paths == 0) return true;
    rest_due_ += rest_per_pass(tracer_.parts() * pass_seconds) / tracer_.parts();
    int paths = std::max(done_ == 0 ? 1 : 0, static_cast<int>(rest_due_));
    if (timed()) {
      if (const auto earlier =
              choices_.earlier("rest_of_pass", static_cast<int>(RestTracing::kMaxBesidePass) + 1))
        paths = static_cast<int>(*earlier);
      choices_.record("rest_of_pass", paths);
    }
    rest_due_ -= paths;
    return paths == 0 || rest_->add_paths(view_, paths, sinks_);
  }

  // Later where many passes fit: what they miss is told from noise by more of them alone.
  void choose_when_to_compare() {
    if (!timed() || !task_.may_be_paths) return;
    if (const auto earlier = choices_.earlier("passes_before_paths", kMaxBeforePaths)) {
      before_paths_ = static_cast<int>(*earlier);
    } else {
      const double fit = left() / (passes_seconds_ / rounds());
      before_paths_ =
          std::clamp(static_cast<int>(kPartBeforePaths * fit), kPassesBeforePaths, kMaxBeforePaths);
    }
    choices_.record("passes_before_paths", before_paths_);
  }
  // False if it was cancelled.
  bool compare_with_paths() {
    if (!timed() || !task_.may_be_paths) return true;
    const auto shown = [this] { report_progress(0), show_preview(); };
    after_.emplace(
        *task_.world, asked_, *passes_, *rest_, *picture_, choices_, [this] { return left(); }, shown,
        sinks_);
    return after_->run(view_, is_smaller(), {passes_seconds_, rounds()});
  }

  // ------------------------------------------------------------ the picture

  bool is_smaller() const { return view_.width < task_.view.width || view_.height < task_.view.height; }

  RenderResult result() {
    result_.interrupted = sinks_.cancelled();
    if (timed()) choices_.record("passes", done_);
    result_.picture = sized_for(picture_->complete(picture_->with_all_noise()), task_.view);
    if (task_.features && passes_->denoising().traced())
      *task_.features = {passes_->denoising().features(), noise_for_a_shot(),
                         passes_->denoising().lacking_filter()};
    if (!result_.interrupted) denoise();
    if (!task_.features) refilter(result_.picture, passes_->denoising().lacking_filter());
    report();
    return std::move(result_);
  }
  image::Image noise_for_a_shot() const {
    if (picture_->by_paths()) return picture_->difference();
    return rounds() > 1 ? passes_->with_noise(*rest_).difference : image::Image{};
  }

  void denoise() {
    const Timer timer;
    const auto denoised =
        passes_->denoising().denoised(picture_->to_denoise(), picture_->sampled_noise(), left());
    if (!denoised) return;
    std::vector<float> before = std::move(result_.picture.planes[0].rgb);
    result_.picture = is_smaller() ? to_picture(passes_->enlarged_with_emission(denoised->picture))
                                   : sized_for(picture_->complete(denoised->picture), task_.view);
    tracer_.estimate().trace.numbers["denoise.kept"] = denoised->kept;
    result_.picture.planes.push_back({"undenoised", std::move(before)});
    seconds_["denoise"] = timer.seconds();
  }

  void report() {
    const bool by_paths = picture_->by_paths();
    auto& numbers = tracer_.estimate().trace.numbers;
    if (rest_->seconds() > 0) seconds_["rest"] = rest_->seconds();
    if (after_ && after_->paths()) {
      seconds_["paths"] = after_->paths()->seconds();
      numbers["paths"] = after_->paths()->paths();
      numbers["paths.light_paths"] = after_->paths()->light_paths();
      numbers["paths.light_paths_aimed"] = after_->paths()->aims_light_paths() ? 1 : 0;
      numbers["passes_over_paths"] = after_->passes_over_paths();
      numbers["share_of_passes"] = picture_->share_of_passes();
    }
    if (result_.interrupted) choices_ = {};
    if (rest_->plan().piloted) numbers["rest.share"] = rest_->plan().pilot.share;
    numbers["rest.paths"] = rest_->paths();
    numbers["rest.light_paths"] = rest_->light_paths();
    numbers["rest.light_paths_aimed"] = rest_->aims_light_paths() ? 1 : 0;
    numbers["passes"] = numbers["receivers_per_pixel"] = static_cast<double>(done_) / tracer_.parts();
    numbers.erase("sampling_rate");
    if (rounds() > 1) {
      numbers["error.noise"] = picture_->noise(ErrorMetric::l1);
      numbers["error.estimate"] = picture_->noise(asked_.method.error_metric);
    }
    if (view_.width < task_.view.width)
      numbers["film.rendered_part"] =
          static_cast<double>(view_.width) / static_cast<double>(task_.view.width);
    auto& notes = tracer_.estimate().trace.notes;
    notes["method.why"] =
        by_paths ? "less noise than by " + task_.info->name + " in the same time" : task_.why;
    passes_->denoising().note(seconds_.contains("denoise"), notes);
    if (!pilot_->shortage().empty()) notes["budget.short"] = pilot_->shortage();
    result_.report = make_report(*tracer_.prepared(), tracer_.traced(), asked_, *task_.info,
                                 tracer_.estimate(), tracer_.cost(), choices_.made());
    if (rounds() > 1)
      result_.report.notes["error.of"] =
          said_of_noise(asked_.method.error_metric, by_paths ? "paths" : "passes");
    if (by_paths) result_.report.method = kByPaths;
    of_all_passes(result_.report);
    seconds_["total"] = task_.timer.seconds();
    result_.report.seconds = seconds_;
  }

  // Sizes are of the last pass until then.
  void of_all_passes(Report& report) const {
    const auto passes = static_cast<std::uint64_t>(done_);
    for (auto* size : {&report.sizes->receivers, &report.sizes->lights, &report.sizes->direct_lights,
                       &report.sizes->light_paths})
      *size *= passes;
    report.cost->sampling_rate /= static_cast<double>(passes);
  }

  RenderTask task_;
  const RenderSettings& asked_;
  Sinks sinks_;
  PreviewCallback preview_;
  PreviewThrottle throttle_;
  bool previews_;
  Clock clock_;
  View view_;  // as rendered
  methods::TimedChoices choices_;
  std::map<std::string, double> seconds_;
  PassTracer tracer_;
  std::optional<PassPicture> passes_;
  std::optional<RestTracing> rest_;
  std::optional<PassPilot> pilot_;
  std::optional<MixedPicture> picture_;
  std::optional<PathsAfterPasses> after_;
  PassPlan plan_{false};
  double rest_due_ = 0;
  int wanted_ = 1, done_ = 0, next_eighths_ = PassPlan::kWhole;
  int before_paths_ = kPassesBeforePaths;
  double passes_seconds_ = 0;
  bool as_asked_ = false;  // their number is given: no clock lowers it
  RenderResult result_;
};

}  // namespace

bool passes_by_default(const scenedesc::SceneDesc& desc, const RenderSettings& settings) {
  return settings.method.name == "auto" &&
         takes_settings(methods::find_method(kMethodOfPasses), settings.method.parameters) &&
         settings.layers.empty() && !settings.view.is_open() && !some_scatter(desc);
}

bool runs_in_passes(const methods::MethodInfo& method, const RenderSettings& settings) {
  return settings.passes > 0 ||
         (method.name == kMethodOfPasses && settings.layers.empty() && !settings.view.is_open());
}

void check_passes(const RenderSettings& settings) {
  if (!settings.layers.empty())
    throw InputError("layers are of one pass, and this render is a mean of passes",
                     "choose another method, or leave out --aov and --passes");
  if (settings.view.is_open())
    throw InputError("an open shutter is not rendered in passes", "leave out --shutter or --passes");
}

RenderResult run_in_passes(RenderTask task, const RenderSettings& settings, const Sinks& sinks,
                           const PreviewCallback& on_preview) {
  return PassRun(std::move(task), settings, sinks, on_preview).run();
}

}  // namespace lumirank::pipeline
