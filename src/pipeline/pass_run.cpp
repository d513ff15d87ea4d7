#include "pipeline/pass_run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "base/error.h"
#include "base/random.h"
#include "methods/common/timed_choices.h"
#include "pipeline/develop.h"
#include "pipeline/layers.h"
#include "pipeline/media_run.h"
#include "pipeline/noise_metric.h"
#include "pipeline/pass_picture.h"
#include "pipeline/pass_plan.h"
#include "pipeline/pass_tracer.h"
#include "pipeline/path_run.h"
#include "pipeline/paths_beside.h"
#include "pipeline/preview_throttle.h"
#include "pipeline/report.h"
#include "pipeline/rest_tracing.h"
#include "pipeline/short_budget.h"
#include "pipeline/smaller_film.h"

namespace lumirank::pipeline {
namespace {

constexpr int kFewPasses = 4, kDefaultPasses = 16, kMaxPasses = 65536;
// Paths of the rest for each pass: without a budget; and within one at least, at most. What of a pass's
// seconds they will take, before that is known, and how noisy a pass is.
constexpr double kRestUntimed = 2, kMinRest = 0.25, kMaxRest = 8;
constexpr double kRestOfPass = 0.3, kNoiseOfPass = 0.5;
// What is compared of a small film. Its passes have fewer lights, whose noise they share, and look worse than
// those of the whole one: of seventeen scenes paths were better in the nine where they look 1.8 times worse
// and more, and not in the eight where they look up to 1.5 times worse (docs/decisions.md).
constexpr int kTrialPasses = 2, kMaxTrialPaths = 32;
constexpr double kSmallPassesLookWorse = 1.6;
// After so many passes paths for all light are tried for this part of the passes' seconds, if so many passes
// more would fit; what a pass takes is foretold to this factor.
constexpr int kPassesBeforePaths = 2;
constexpr double kPartOfTrial = 0.4, kWorthATrial = 3, kUnsure = 1.25;
constexpr int kMaxBeside = 1 << 16;
// Paths go alone where the rest is more of the light than this.
constexpr double kRestForPaths = 0.2;
// What a pass counts for beside a path for each pixel, where it is asked whether all pixels are worth it.
constexpr double kPathsWorthAPass = 2.5;
// Passes of half the film that are better than paths, or than few whole ones that take as long as so many
// paths for each pixel; than the only one.
constexpr double kPassesOfHalf = 3, kPathsOfPass = 5, kPathsOfOnlyPass = 2;
// Of the picture's light that passes show and paths have not found: above that it is none of their noise.
constexpr double kMissed = 0.03;
// Passes of which a path for each pixel takes longer than this part are not compared with paths: to find out
// takes two of these at least, which was a third of ten seconds among thousands of lamps.
constexpr double kDearPath = 0.75;
// Passes of interleaved pixels: of every second in x and y, where fewer rounds of them than this fit.
constexpr int kMaxSide = 2;
constexpr double kManyRounds = 4;
// Rounds that are worth more than a film of half the size: one for so many pixels, of which the first may be
// of passes this much smaller.
constexpr double kPixelsOfRound = 300000, kMinRound = 0.75, kMaxRounds = 3;
constexpr int kPathsForError = 16;  // before a target for the error is believed
// Seconds after which a run by paths can be interrupted, or its preview shown.
constexpr double kPathsAtOnce = 0.5;
constexpr int kTrialDivisor = 4, kMaxDivisorOfPasses = 4;
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
        whole_(task_.view),
        parts_(wanted_parts(asked.view.only)),
        tracer_(task_.world, *task_.info, std::move(task_.method), asked, sinks, seconds_) {
    seconds_["build"] = task_.build_seconds;
    if (!asked.choices.empty()) choices_ = methods::TimedChoices(asked.choices);
  }

  RenderResult run() {
    sinks_.say("method: " + task_.info->name + " (" + task_.why + ")");
    picture_.emplace(asked_, view_, choices_, sinks_);
    view_ = whole_ = picture_->denoising().filtered(view_);
    rest_.emplace(task_.world, view_, asked_, sinks_);
    if (rest_->plan().piloted) seconds_["rest_pilot"] = rest_->pilot_seconds();
    if (rest_is_most()) return by_paths_alone("columns cannot carry much of its light");
    const Timer survey_timer;
    tracer_.aim(survey(task_.world, view_, tracer_.recipe_of(0, view_), sinks_));
    seconds_["survey"] = survey_timer.seconds();
    plan();
    if (paths_alone_) return by_paths_alone("few passes would fit, and on a small film paths had less noise");
    while (wants_more()) {
      set_size();
      if (!pass(passes_)) break;
      ++passes_;
      if (passes_ == kPassesBeforePaths * tracer_.parts() && !compare_with_paths()) break;
    }
    if (rounds() == 0) throw Cancelled();
    return picture();
  }

 private:
  bool timed() const { return asked_.time > 0; }
  bool replays() const { return !asked_.choices.empty(); }

  // Each shows every pixel once.
  int rounds() const { return passes_ / tracer_.parts(); }

  // What takes longer the larger a pass is.
  double seconds_drawing() { return seconds_["method"] + seconds_["lights"]; }

  // ------------------------------------------------------------ how many

  void plan() {
    const int by_hand = asked_.passes > 0 ? asked_.passes : asked_.view.spp.value_or(0);
    as_asked_ = by_hand > 0;
    if (timed() && !replays()) {
      // Not kept: its pixels are too large.
      const View small = smaller(view_, kTrialDivisor);
      image::Image image;
      PassSeconds took;
      const auto before = seconds_;
      if (!tracer_.trace(kMaxPasses, small, image, took)) throw Cancelled();
      seconds_ = before, tracer_.forget_cost();
      seconds_["pilot"] = took.total();
      const double shrunk = static_cast<double>(small.width) * static_cast<double>(small.height) /
                            (static_cast<double>(view_.width) * static_cast<double>(view_.height));
      expected_ = {took.fixed * static_cast<double>(tracer_.lights_of(view_)) /
                       static_cast<double>(tracer_.lights_of(small)),
                   took.by_pixel / shrunk};
      const double one_feature = picture_->denoising().seconds_of_feature(
          *task_.world, small, tracer_.recipe_of(kMaxPasses, small), sinks_);
      left_for_features_ = left();
      features_expected_ = picture_->denoising().feature_seconds(one_feature / shrunk, left_for_features_);
      const bool few = too_few_fit(kUnsure);
      paths_alone_ = few && small_paths_are_better(small, image, shrunk);
      if (paths_alone_) return;
      const bool half = too_few_fit() && is_dear() && may_be_half(one_feature / shrunk);
      choose_size(half ? 2 : 1);
    } else if (timed()) {
      const auto divisor = choices_.earlier("film_divisor", kMaxDivisorOfPasses).value_or(1);
      choices_.record("film_divisor", divisor);
      make_smaller(static_cast<int>(divisor));
    }
    if (timed()) interleave();
    wanted_ = as_asked_ ? by_hand
              : timed() || asked_.method.target_error > 0
                  ? kMaxPasses
                  : static_cast<int>(std::lround(kDefaultPasses * task_.part_of_usual));
    if (timed()) {
      if (const auto earlier = choices_.earlier("passes", kMaxPasses)) wanted_ = static_cast<int>(*earlier);
    }
    plan_ = PassPlan(resizes(), tracer_.parts());
    const double with_rest = 1 + rest_share();
    const double by_pixel = with_rest * expected_.by_pixel / tracer_.parts();
    const double fixed = with_rest * expected_.fixed / std::sqrt(tracer_.parts());
    plan_.expect((1 - kDrawingShare) * by_pixel, (fixed + kDrawingShare * by_pixel) / PassPlan::kWhole);
  }

  void make_smaller(int divisor) {
    if (divisor > 1) view_ = smaller(whole_, divisor);
    picture_->make_smaller(divisor);
  }

  // Few passes are each of some of the pixels, so that what these share by their lights is noise among
  // neighbors; a round takes twice as many lights.
  void interleave() {
    int side = may_interleave() && left() < kManyRounds * (2 * expected_.fixed + expected_.by_pixel) ? 2 : 1;
    if (const auto earlier = choices_.earlier("interleaved", kMaxSide); earlier && may_interleave())
      side = static_cast<int>(*earlier);
    choices_.record("interleaved", side);
    tracer_.interleave(side);
  }
  // That needs a filter no wider than a pixel, which denoised pictures have, and receivers that are the film
  // samples. A frame averaged with its neighbors needs the noise of halves, which one round does not tell.
  bool may_interleave() const {
    return resizes() && picture_->denoising().wanted() && !asked_.view.film_samples && !task_.features;
  }

  // A film of half the width and height, enlarged, is better than none.
  void choose_size(int at_least) {
    const double whole = expected_.total() * (1 + rest_share());  // a pass of the whole film
    const double enough = asked_.time - left() + kFewPasses * whole;
    if (rounds_worth_a_pixel() * expected_.total() > left()) at_least = 2;
    int divisor = 1;
    const bool may = is_whole_film(task_.view);
    while (may && divisor < kMaxDivisorOfPasses && (divisor < at_least || min_round_seconds() > left())) {
      divisor *= 2;
      make_smaller(divisor);
      expected_.by_pixel /= 4;
    }
    choices_.record("film_divisor", divisor);
    const double left_now = left();
    if (divisor == 1 && min_round_seconds() <= left_now) return;
    shortage_ = said({asked_.time, task_.build_seconds, asked_.time < task_.build_seconds, enough},
                     said_of_smaller(divisor));
    sinks_.warn(shortage_);
  }
  // With fewer rounds half the film is better.
  double rounds_worth_a_pixel() const {
    if (!picture_->denoising().wanted()) return 1;
    if (!may_interleave()) return std::max(1.0, paths_worth_a_pixel(whole_) / kPathsWorthAPass);
    const double pixels = static_cast<double>(whole_.width) * static_cast<double>(whole_.height);
    return std::clamp(pixels / kPixelsOfRound, kMinRound, kMaxRounds);
  }
  // Seconds, by passes with fewer lights where they may have these.
  double min_round_seconds() const { return (may_interleave() ? kMinRound : 1) * expected_.total(); }

  // Passes may have other numbers of lights, of which receivers draw as many fewer or more.
  bool resizes() const {
    return timed() && !as_asked_ && !asked_.method.parameters.contains("samples") &&
           task_.info->name == kMethodOfPasses;
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

  double end() const { return asked_.time - picture_->denoising().seconds(); }
  double left() const { return end() - clock_() - (passes_ == 0 ? features_expected_ : 0); }
  double rest_share() const { return rest_->plan().paths > 0 ? kRestOfPass : 0; }

  bool wants_more() {
    if (by_paths_) return false;
    next_eighths_ = timed() && !as_asked_ ? plan_.next(left()) : PassPlan::kWhole;
    if (sinks_.cancelled()) return false;
    if (passes_ >= wanted_) return false;
    if (rounds() == 0) return true;
    if (asked_.method.target_error > 0 && rounds() >= kFewPasses && noise() < asked_.method.target_error)
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
    Recipe of_film = tracer_.recipe_of(static_cast<std::uint64_t>(number), view_);
    of_film.seed = hash_ids(asked_.seed, Stage::film_samples, of_film.pass);
    // A pass has as many samples as its size.
    const double weight = static_cast<double>(tracer_.eighths()) / PassPlan::kWhole;
    const PassPicture::Pass shown{number / tracer_.parts(), wanted_, weight,
                                  of_film.pixels.in_window(view_.crop_x, view_.crop_y),
                                  number % tracer_.parts() == 0};
    of_film.pixels = {};
    // The first of a round does not tell what is left after it: later ones are planned by what features took.
    const double left_for_features = tracer_.parts() > 1 ? left_for_features_ : left();
    const Timer timer;
    if (!picture_->add(shown, image,
                       {*task_.world, view_, of_film, *tracer_.prepared()->rows, tracer_.traced()},
                       timed() ? left_for_features : 0, sinks_))
      return false;
    seconds_["features"] += timer.seconds();
    report_progress(number + 1);
    if (previews_ && number + 1 >= tracer_.parts() && throttle_.due())
      throttle_.show(sized_for(picture_->with_emission(sent()), task_.view));
    return true;
  }

  void report_progress(int passes) const {
    const double part = timed() ? (clock_() - task_.build_seconds) / (asked_.time - task_.build_seconds)
                                : static_cast<double>(passes) / wanted_;
    sinks_.report("passes", std::clamp(part, 0.0, 1.0));
  }

  // Two sorts of noise are least together, for their seconds, where each has samples in proportion to its
  // deviation over the root of what a sample takes.
  double rest_per_pass(double pass_seconds) const {
    const double all = static_cast<double>(view_.width) * static_cast<double>(view_.height) *
                       rest_->plan().pilot.path_seconds;
    if (!timed() || !(all > 0)) return kRestUntimed;
    const double of_pass = rounds() >= kFewPasses ? picture_->noise() * std::sqrt(rounds()) : kNoiseOfPass;
    return std::clamp(rest_->plan().pilot.deviation / of_pass * std::sqrt(pass_seconds / all), kMinRest,
                      kMaxRest);
  }
  bool add_rest(double pass_seconds) {
    if (rest_->plan().paths == 0) return true;
    rest_due_ += rest_per_pass(tracer_.parts() * pass_seconds) / tracer_.parts();
    int paths = std::max(passes_ == 0 ? 1 : 0, static_cast<int>(rest_due_));
    if (timed()) {
      if (const auto earlier = choices_.earlier("rest_of_pass", static_cast<int>(kMaxRest) + 1))
        paths = static_cast<int>(*earlier);
      choices_.record("rest_of_pass", paths);
    }
    rest_due_ -= paths;
    return paths == 0 || rest_->add_paths(view_, paths, sinks_);
  }

  // ------------------------------------------------------------ or paths

  bool may_be_paths_alone() const { return timed() && task_.may_be_paths; }
  bool rest_is_most() const {
    if (replays()) return asked_.choices.contains(kChoiceOfPaths);
    // Where paths from the lamps are worth their time, these are hard to find from the eye, and through glass
    // no path finds what they have lit: then passes come first, and show what paths would miss.
    return task_.may_be_paths && rest_->plan().piloted && rest_->plan().light_paths == 0 &&
           rest_->plan().pilot.share > kRestForPaths;
  }
  // Of one path for each pixel, as the rest's pilot says; 0: there was none.
  double path_seconds() const {
    return rest_->plan().pilot.whole_path_seconds * static_cast<double>(view_.width) *
           static_cast<double>(view_.height);
  }
  // There is no time to find out of the whole film whether paths have less noise.
  bool too_few_fit(double times = 1) const {
    const double pass = expected_.total() * (1 + rest_share()), passes = kPassesBeforePaths + kWorthATrial;
    return may_be_paths_alone() && rest_->plan().piloted && times * passes * pass > left();
  }
  // Passes are few, and each takes as long as many paths.
  bool is_dear() const {
    const double pass = expected_.total() * (1 + rest_share());
    const bool is_only_one = min_round_seconds() * (1 + rest_share()) > left();
    return kFewPasses * pass > left() &&
           pass > (is_only_one ? kPathsOfOnlyPass : kPathsOfPass) * path_seconds();
  }
  // Where paths alone would be of a smaller film as well, passes of that one are tried if some fit.
  bool may_be_half(double one_feature) {
    const double path = path_seconds();
    if (!is_whole_film(task_.view) || !picture_->denoising().wanted() ||
        left() > paths_worth_a_pixel(view_) * path)
      return false;
    picture_->make_smaller(2);
    const double before = features_expected_;
    features_expected_ = picture_->denoising().feature_seconds(one_feature, left());
    if (kPassesOfHalf * (expected_.fixed + expected_.by_pixel / 4) * (1 + rest_share()) < left()) return true;
    picture_->make_smaller(1);
    features_expected_ = before;
    return false;
  }
  // Asked of a film of this part of the pixels, where there is no time to ask the whole one: with paths of
  // the same seconds, since what is rarely found has no less noise in twice as many. Light that passes show
  // and paths do not is found out as well.
  bool small_paths_are_better(const View& small, const image::Image& first, double shrunk) {
    const double seconds = kTrialPasses * expected_.total() * (1 + rest_share());
    image::Image second;
    PassSeconds took;
    const auto before = seconds_;
    if (!tracer_.trace(kMaxPasses + 1, small, second, took)) throw Cancelled();
    seconds_ = before, tracer_.forget_cost();
    NoisyPicture by_passes{first, first};
    for (std::size_t p = 0; p < first.pixels.size(); ++p) {
      by_passes.picture.pixels[p] = 0.5f * (first.pixels[p] + second.pixels[p]);
      by_passes.difference.pixels[p] = first.pixels[p] - second.pixels[p];
    }
    PathsBeside paths(*task_.world, small, asked_, sinks_);
    do {
      if (!paths.add(2, sinks_)) throw Cancelled();
    } while (paths.seconds() < shrunk * seconds && paths.paths() < kMaxTrialPaths);
    const NoisyPicture by_paths{paths.sent(), paths.sent_difference()};
    if (missed_by_paths(by_passes, by_paths) > kMissed) return false;
    return passes_over_paths(by_passes, seconds, by_paths, paths.seconds() / shrunk,
                             paths.light_paths() > 0) > kSmallPassesLookWorse;
  }
  RenderResult by_paths_alone(const char* why) {
    task_.why = why;
    task_.denoiser_pixel_seconds = picture_->denoising().pixel_seconds();
    RenderSettings settings = asked_;
    // What no clock decided is decided again where the report is repeated.
    if (!timed()) settings.method.name = "auto";
    return run_by_paths(std::move(task_), settings, sinks_, preview_);
  }

  // False if it was cancelled.
  bool compare_with_paths() {
    if (!timed() || !task_.may_be_paths) return true;
    if (!try_paths()) return false;
    choices_.record("trial_paths", paths_ ? paths_->paths() : 0);
    if (!paths_) return true;
    const auto by_paths = choices_.earlier("by_paths", 1), more = choices_.earlier("more_paths", kMaxBeside);
    passes_over_paths_ = passes_over_paths(picture_->with_noise(*rest_), passes_seconds_,
                                           {paths_->sent(), paths_->sent_difference()}, paths_->seconds(),
                                           paths_->light_paths() > 0);
    const double missed =
        missed_by_paths(picture_->with_noise(*rest_), {paths_->sent(), paths_->sent_difference()});
    by_paths_ = by_paths ? *by_paths == 1 : passes_over_paths_ > 1 && missed < kMissed;
    choices_.record("by_paths", by_paths_ ? 1 : 0);
    char ratio[32];
    std::snprintf(ratio, sizeof ratio, "%.2g", passes_over_paths_);
    sinks_.say(std::string("noise of passes over that of paths in the same time: ") + ratio +
               (by_paths_ ? ", so paths go on" : ", so passes go on"));
    if (by_paths_) choose_emission();
    const int before = paths_->paths();
    const bool whole = !by_paths_ || go_on_by_paths(more);
    choices_.record("more_paths", paths_->paths() - before);
    if (by_paths_) choose_share();
    return whole;
  }

  // Passes that are done count too, though paths go on.
  void choose_share() {
    constexpr int kParts = 1000;
    const double share = share_of_passes(passes_over_paths_, passes_seconds_, paths_->seconds());
    const auto earlier = choices_.earlier("share_of_passes", kParts);
    const std::int64_t parts = earlier ? *earlier : std::lround(kParts * share);
    choices_.record("share_of_passes", parts);
    share_of_passes_ = static_cast<float>(parts) / kParts;
  }

  // Theirs, or film samples apart, which go on with them then.
  void choose_emission() {
    const double each = paths_->seconds() / paths_->paths();
    own_emission_ = (!parts_.emission ||
                     own_emission_over_apart(*paths_, paths_->paths() + std::max(0.0, left()) / each) < 1) &&
                    !is_smaller();
    if (const auto earlier = choices_.earlier("own_emission", 1)) own_emission_ = *earlier == 1;
    choices_.record("own_emission", own_emission_ ? 1 : 0);
  }

  bool try_paths() {
    const auto earlier = choices_.earlier("trial_paths", kMaxBeside);
    const double pass = passes_seconds_ / rounds();
    if (earlier ? *earlier == 0 : left() < kWorthATrial * pass || path_seconds() > kDearPath * pass)
      return true;
    paths_.emplace(*task_.world, view_, asked_, sinks_);
    if (earlier) return paths_->add(static_cast<int>(*earlier), sinks_);
    if (!paths_->add(1, sinks_)) return false;
    if (paths_->seconds() > kDearPath * pass) {
      paths_.reset();
      return true;
    }
    for (int more = 1; more == 1 || paths_->seconds() < kPartOfTrial * passes_seconds_; more = 2)
      if (!paths_->add(more, sinks_)) return false;
    return true;
  }

  // Until the budget is over, or as many as an earlier run had.
  bool go_on_by_paths(std::optional<std::int64_t> earlier) {
    int check_error_at = kPathsForError;
    for (std::int64_t done = 0;;) {
      if (!earlier && asked_.method.target_error > 0 && paths_->paths() >= check_error_at) {
        if (noise() < asked_.method.target_error) return true;
        check_error_at = static_cast<int>(kPathsToAskAgain * paths_->paths());
      }
      const double each = paths_->seconds() / paths_->paths();
      const std::int64_t wanted = earlier ? *earlier - done : paths_that_fit(left(), each, asked_.time);
      if (wanted < 1) return true;
      const auto more =
          std::min(wanted, std::max<std::int64_t>(1, static_cast<std::int64_t>(kPathsAtOnce / each)));
      if (!paths_->add(static_cast<int>(more), sinks_)) return false;
      done += more;
      if (!own_emission_ && !features_of_paths()) return false;
      report_progress(0);
      if (previews_ && throttle_.due()) throttle_.show(finished(with_all_noise()));
    }
  }

  // As many as the paths say, in whatever portions these came.
  bool features_of_paths() {
    constexpr int kPathsForOne = 8, kFirstNumber = 1 << 10;
    if (!picture_->denoising().traced()) return true;
    for (; features_of_paths_ < paths_->paths() / kPathsForOne; ++features_of_paths_)
      if (!picture_->trace_another(kFirstNumber + features_of_paths_, sinks_)) return false;
    return true;
  }

  // ------------------------------------------------------------ the picture

  // Of the picture, as the metric of the target for the error counts it.
  double noise() const {
    const ErrorMetric metric = asked_.method.error_metric;
    if (metric == ErrorMetric::l1) return l1_noise();
    if (by_paths_)
      return noise_by(metric, with_share_and_emission(paths_->picture()),
                      with_share_of_noise(paths_->difference()));
    const NoisyPicture passes = picture_->with_noise(*rest_);
    return noise_by(metric, passes.picture, passes.difference);
  }
  double l1_noise() const {
    const double of_passes = picture_->noise(), share = share_of_passes_;
    return by_paths_ ? std::hypot((1 - share) * paths_->error(), share * of_passes) : of_passes;
  }
  image::Image sent() const {
    return picture_->with_mirrored(by_paths_ ? with_share(paths_->sent()) : picture_->sent(*rest_));
  }
  // The mean of paths and passes: without emission, with it, and of differences.
  image::Image with_share(image::Image of_paths) const {
    if (share_of_passes_ == 0) return of_paths;
    return shared(std::move(of_paths), picture_->sent(*rest_));
  }
  image::Image with_share_and_emission(image::Image of_paths) const {
    if (share_of_passes_ == 0) return of_paths;
    return shared(std::move(of_paths),
                  picture_->with_emission(picture_->with_mirrored(picture_->sent(*rest_))));
  }
  image::Image with_share_of_noise(image::Image of_paths) const {
    if (share_of_passes_ == 0) return of_paths;
    return shared(std::move(of_paths), picture_->with_noise(*rest_).difference);
  }
  image::Image shared(image::Image of_paths, const image::Image& of_passes) const {
    for (std::size_t p = 0; p < of_paths.pixels.size(); ++p)
      of_paths.pixels[p] += share_of_passes_ * (of_passes.pixels[p] - of_paths.pixels[p]);
    return of_paths;
  }
  bool is_smaller() const { return view_.width < whole_.width || view_.height < whole_.height; }
  bool has_own_emission() const { return by_paths_ && own_emission_; }
  // What has noise; and a picture of that kind with all that it lacks.
  image::Image with_all_noise() const {
    return has_own_emission() ? with_share_and_emission(paths_->picture()) : sent();
  }
  image::Image to_denoise() const {
    if (!by_paths_) return with_all_noise();
    image::Image clean = pipeline::without_fireflies(paths_->film(), has_own_emission());
    return has_own_emission() ? with_share_and_emission(std::move(clean))
                              : picture_->with_mirrored(with_share(std::move(clean)));
  }
  Picture finished(const image::Image& image) const {
    return sized_for(has_own_emission() ? image : picture_->with_emission(image), task_.view);
  }

  // Twice the noise of what is denoised; empty where it is not known well: halves of few passes may agree on
  // a speck, which would stay.
  image::Image difference() const {
    if (!by_paths_ || paths_->paths() < PictureDenoising::kPathsForNoise) return {};
    if (has_own_emission()) return with_share_of_noise(paths_->difference());
    return picture_->with_mirrored_as_noise(with_share_of_noise(paths_->sent_difference()));
  }

  image::Image noise_of_passes() const {
    return rounds() > 1 ? picture_->with_noise(*rest_).difference : image::Image{};
  }

  RenderResult picture() {
    result_.interrupted = sinks_.cancelled();
    if (timed()) choices_.record("passes", passes_);
    const image::Image all = with_all_noise();
    result_.picture = finished(all);
    if (task_.features && picture_->denoising().traced())
      *task_.features = {picture_->denoising().features(), by_paths_ ? difference() : noise_of_passes()};
    if (!result_.interrupted) {
      const Timer timer;
      if (const auto denoised = picture_->denoising().denoised(to_denoise(), difference())) {
        std::vector<float> before = std::move(result_.picture.planes[0].rgb);
        result_.picture = is_smaller() ? to_picture(picture_->enlarged_with_emission(denoised->picture))
                                       : finished(denoised->picture);
        tracer_.estimate().trace.numbers["denoise.kept"] = denoised->kept;
        result_.picture.planes.push_back({"undenoised", std::move(before)});
        seconds_["denoise"] = timer.seconds();
      }
    }
    report();
    return std::move(result_);
  }

  void report() {
    if (rest_->seconds() > 0) seconds_["rest"] = rest_->seconds();
    if (paths_) {
      seconds_["paths"] = paths_->seconds();
      tracer_.estimate().trace.numbers["paths"] = paths_->paths();
      tracer_.estimate().trace.numbers["paths.light_paths"] = paths_->light_paths();
      tracer_.estimate().trace.numbers["passes_over_paths"] = passes_over_paths_;
      tracer_.estimate().trace.numbers["share_of_passes"] = share_of_passes_;
    }
    auto& numbers = tracer_.estimate().trace.numbers;
    if (result_.interrupted) choices_ = {};
    if (rest_->plan().piloted) numbers["rest.share"] = rest_->plan().pilot.share;
    numbers["rest.paths"] = rest_->paths();
    numbers["rest.light_paths"] = rest_->light_paths();
    numbers["passes"] = numbers["receivers_per_pixel"] = static_cast<double>(passes_) / tracer_.parts();
    numbers.erase("sampling_rate");
    if (rounds() > 1) {
      numbers["error.noise"] = l1_noise();
      numbers["error.estimate"] = noise();
    }
    if (view_.width < task_.view.width)
      numbers["film.rendered_part"] =
          static_cast<double>(view_.width) / static_cast<double>(task_.view.width);
    tracer_.estimate().trace.notes["method.why"] =
        by_paths_ ? "less noise than by " + task_.info->name + " in the same time" : task_.why;
    picture_->denoising().note(seconds_.contains("denoise"), tracer_.estimate().trace.notes);
    if (!shortage_.empty()) tracer_.estimate().trace.notes["budget.short"] = shortage_;
    result_.report = make_report(*tracer_.prepared(), tracer_.traced(), asked_, *task_.info,
                                 tracer_.estimate(), tracer_.cost(), choices_.made());
    if (rounds() > 1)
      result_.report.notes["error.of"] =
          said_of_noise(asked_.method.error_metric, by_paths_ ? "paths" : "passes");
    if (by_paths_) result_.report.method = kByPaths;
    of_all_passes(result_.report);
    seconds_["total"] = task_.timer.seconds();
    result_.report.seconds = seconds_;
  }

  // Sizes are of the last pass until then.
  void of_all_passes(Report& report) const {
    const auto passes = static_cast<std::uint64_t>(passes_);
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
  View view_, whole_;  // as rendered, and of the size that was asked for
  FilmParts parts_;
  methods::TimedChoices choices_;
  std::optional<PassPicture> picture_;
  std::optional<RestTracing> rest_;
  std::map<std::string, double> seconds_;
  PassTracer tracer_;
  PassSeconds expected_;
  double features_expected_ = 0;  // what follows the first pass
  double left_for_features_ = 0;  // seconds of the budget, by which these were foretold
  PassPlan plan_{false};
  double rest_due_ = 0;
  int wanted_ = 1, passes_ = 0, next_eighths_ = PassPlan::kWhole;
  std::optional<PathsBeside> paths_;
  double passes_seconds_ = 0, passes_over_paths_ = 0;
  bool paths_alone_ = false;
  bool by_paths_ = false;      // after the first passes
  bool own_emission_ = false;  // of paths that go on
  float share_of_passes_ = 0;  // in the mean with paths that go on
  int features_of_paths_ = 0;
  bool as_asked_ = false;  // their number is given: no clock lowers it
  std::string shortage_;
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
