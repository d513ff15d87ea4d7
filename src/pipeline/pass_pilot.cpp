#include "pipeline/pass_pilot.h"

#include <algorithm>
#include <cmath>

#include "pipeline/pass_run.h"
#include "pipeline/paths_after_passes.h"
#include "pipeline/paths_beside.h"
#include "pipeline/short_budget.h"
#include "pipeline/smaller_film.h"

namespace lumirank::pipeline {
namespace {

constexpr int kMaxDivisorOfPasses = 4;
// What the rest takes of a pass's seconds at least, before that is known; what a pass takes is foretold to
// the second factor.
constexpr double kRestOfPass = 0.3, kUnsure = 1.25;
// What is compared of a small film. Its passes have fewer lights, whose noise they share, and look worse than
// those of the whole one: with a quarter of its width, of seventeen scenes paths were better in the nine
// where they look 1.8 times worse and more, and not in the eight where they look up to 1.5 times worse
// (docs/decisions.md). 4^0.34 is 1.6; of a smaller part, which has as many times fewer lights, the same power
// is taken.
constexpr int kTrialPasses = 2, kMaxTrialPaths = 32;
constexpr double kPowerOfLookingWorse = 0.34;
// What a pass counts for beside a path for each pixel, where it is asked whether all pixels are worth it.
constexpr double kPathsWorthAPass = 2.5;
// Passes of half the film that are better than paths, or than few whole ones that take as long as so many
// paths for each pixel; than the only one.
constexpr double kPassesOfHalf = 3, kPathsOfPass = 5, kPathsOfOnlyPass = 2;
// Passes of interleaved pixels: of every second in x and y, where fewer rounds of them than this fit.
constexpr int kMaxSide = 2;
constexpr double kManyRounds = 4;
// Rounds that are worth more than a film of half the size: one for so many pixels, of which the first may be
// of passes this much smaller.
constexpr double kPixelsOfRound = 300000, kMinRound = 0.75, kMaxRounds = 6;

double pixels_of(const View& view) {
  return static_cast<double>(view.width) * static_cast<double>(view.height);
}

}  // namespace

PassPilot::PassPilot(const RenderTask& task, const View& view, const RenderSettings& settings,
                     PassTracer& tracer, PassPicture& picture, const RestTracing& rest,
                     methods::TimedChoices& choices, std::map<std::string, double>& seconds,
                     const Sinks& sinks)
    : task_(task),
      settings_(settings),
      tracer_(tracer),
      picture_(picture),
      rest_(rest),
      choices_(choices),
      seconds_(seconds),
      sinks_(sinks),
      whole_(view),
      view_(view) {}

void PassPilot::run() {
  // Not kept: its pixels are too large.
  const View small = smaller(whole_, trial_divisor(whole_));
  image::Image image;
  PassSeconds took;
  const auto before = seconds_;
  if (!tracer_.trace(kMaxPasses, small, image, took)) throw Cancelled();
  seconds_ = before, tracer_.forget_cost();
  seconds_["pilot"] = took.total();
  const double shrunk = pixels_of(small) / pixels_of(whole_);
  expected_ = {took.fixed * static_cast<double>(tracer_.lights_of(whole_)) /
                   static_cast<double>(tracer_.lights_of(small)),
               took.by_pixel / shrunk};
  const double one_feature = picture_.denoising().seconds_of_feature(
                                 *task_.world, small, tracer_.recipe_of(kMaxPasses, small), sinks_) /
                             shrunk;
  features_expected_ = picture_.denoising().feature_seconds(one_feature, left());
  paths_alone_ = too_few_fit(kUnsure) && small_paths_are_better(small, image, shrunk);
  if (paths_alone_) return;
  const bool half = too_few_fit(1) && is_dear() && may_be_half(one_feature);
  choose_size(half ? 2 : 1);
  interleave();
}

void PassPilot::repeat() {
  const auto divisor = choices_.earlier("film_divisor", kMaxDivisorOfPasses).value_or(1);
  choices_.record("film_divisor", divisor);
  make_smaller(static_cast<int>(divisor));
  interleave();
}

bool PassPilot::resizes() const {
  return settings_.time > 0 && settings_.passes == 0 && settings_.view.spp.value_or(0) == 0 &&
         !settings_.method.parameters.contains("samples") && task_.info->name == kMethodOfPasses;
}
double PassPilot::with_rest() const {
  if (rest_.plan().paths == 0) return 1;
  const double pass = expected_.total(), path = rest_.seconds_of_path(view_);
  if (!(pass > 0 && path > 0)) return 1 + kRestOfPass;
  return 1 + std::max(kRestOfPass, rest_.paths_beside_pass(view_, pass, kNoiseOfPass) * path / pass);
}
double PassPilot::left() const {
  return settings_.time - picture_.denoising().seconds() - task_.timer.seconds() - features_expected_;
}

// ------------------------------------------------------------ size

void PassPilot::make_smaller(int divisor) {
  if (divisor > 1) view_ = smaller(whole_, divisor);
  picture_.make_smaller(divisor);
}

// A film of half the width and height, enlarged, is better than none.
void PassPilot::choose_size(int at_least) {
  const double enough = settings_.time - left() + kFewPasses * expected_with_rest();
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
  shortage_ = said({settings_.time, task_.build_seconds, settings_.time < task_.build_seconds, enough},
                   said_of_smaller(divisor));
  sinks_.warn(shortage_);
}

// With fewer rounds half the film is better.
double PassPilot::rounds_worth_a_pixel() const {
  if (!picture_.denoising().wanted()) return 1;
  if (!may_interleave()) return std::max(1.0, paths_worth_a_pixel(whole_) / kPathsWorthAPass);
  return std::clamp(pixels_of(whole_) / kPixelsOfRound, kMinRound, kMaxRounds);
}
// Seconds, by passes with fewer lights where they may have these.
double PassPilot::min_round_seconds() const { return (may_interleave() ? kMinRound : 1) * expected_.total(); }

// Few passes are each of some of the pixels, so that what these share by their lights is noise among
// neighbors; a round takes twice as many lights.
void PassPilot::interleave() {
  int side =
      may_interleave() && left() < kManyRounds * (2 * expected_.fixed + expected_.by_pixel) ? kMaxSide : 1;
  if (const auto earlier = choices_.earlier("interleaved", kMaxSide); earlier && may_interleave())
    side = static_cast<int>(*earlier);
  choices_.record("interleaved", side);
  tracer_.interleave(side);
}
// That needs a filter no wider than a pixel, which denoised pictures have, and receivers that are the film
// samples. A frame averaged with its neighbors needs the noise of halves, which one round does not tell.
bool PassPilot::may_interleave() const {
  return resizes() && picture_.denoising().wanted() && !settings_.view.film_samples && !task_.features;
}

// ------------------------------------------------------------ or paths

// There is no time to find out of the whole film whether paths have less noise.
bool PassPilot::too_few_fit(double times) const {
  constexpr double kPasses = kPassesBeforePaths + kWorthATrial;
  return settings_.time > 0 && task_.may_be_paths && rest_.plan().piloted &&
         times * kPasses * expected_with_rest() > left();
}
// Passes are few, and each takes as long as many paths.
bool PassPilot::is_dear() const {
  const double pass = expected_with_rest();
  const bool is_only_one = min_round_seconds() * with_rest() > left();
  return kFewPasses * pass > left() &&
         pass > (is_only_one ? kPathsOfOnlyPass : kPathsOfPass) * rest_.seconds_of_whole_path(view_);
}
// Where paths alone would be of a smaller film as well, passes of that one are tried if some fit.
bool PassPilot::may_be_half(double one_feature) {
  if (!is_whole_film(task_.view) || !picture_.denoising().wanted() ||
      left() > paths_worth_a_pixel(view_) * rest_.seconds_of_whole_path(view_))
    return false;
  picture_.make_smaller(2);
  const double before = features_expected_;
  features_expected_ = picture_.denoising().feature_seconds(one_feature, left());
  if (kPassesOfHalf * (expected_.fixed + expected_.by_pixel / 4) * with_rest() < left()) return true;
  picture_.make_smaller(1);
  features_expected_ = before;
  return false;
}
// Asked of a film of this part of the pixels, where there is no time to ask the whole one: with paths of
// the same seconds, since what is rarely found has no less noise in twice as many. Light that passes show
// and paths do not is found out as well.
bool PassPilot::small_paths_are_better(const View& small, const image::Image& first, double shrunk) {
  const double seconds = kTrialPasses * expected_with_rest();
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
  if (rest_.plan().paths > 0) {
    RestTracing rest(task_.world, settings_, rest_.plan());
    if (!rest.add_paths(small, kTrialPasses, sinks_)) throw Cancelled();
    rest.add_to(by_passes.picture), rest.add_difference_to(by_passes.difference);
  }
  PathsBeside paths(*task_.world, small, settings_, nullptr, sinks_);
  light_paths_ = paths.light_path_pilot();
  do {
    if (!paths.add(2, sinks_)) throw Cancelled();
  } while (paths.seconds() < shrunk * seconds && paths.paths() < kMaxTrialPaths);
  const NoisyPicture by_paths{paths.sent(), paths.sent_difference()};
  if (missed_light(by_passes, by_paths) > kMissedByPaths) return false;
  return passes_over_paths(by_passes, seconds, by_paths, paths.seconds() / shrunk, paths.light_paths() > 0) >
         std::pow(trial_divisor(whole_), kPowerOfLookingWorse);
}

}  // namespace lumirank::pipeline
