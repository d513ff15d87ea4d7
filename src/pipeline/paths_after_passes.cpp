#include "pipeline/paths_after_passes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "pipeline/develop.h"
#include "pipeline/path_run.h"

namespace lumirank::pipeline {
namespace {

// The trial takes this part of the passes' seconds.
constexpr double kPartOfTrial = 0.4;
constexpr int kMaxBeside = 1 << 16;
// Where a path for each pixel takes longer than this part of a pass, and of what is left of the time, passes
// are not compared with paths: to find out takes two of these at least, which was a third of ten seconds
// among thousands of lamps.
constexpr double kDearPath = 0.75, kDearOfLeft = 0.02;
constexpr int kPathsForError = 16;  // before a target for the error is believed
// Seconds after which a run by paths can be interrupted, or its preview shown.
constexpr double kPathsAtOnce = 0.5;

}  // namespace

bool PathsAfterPasses::run(const View& view, bool is_smaller, const Passes& passes) {
  if (!try_out(view, passes)) return false;
  choices_.record("trial_paths", paths_ ? paths_->paths() : 0);
  if (!paths_) return true;
  const auto by_paths = choices_.earlier("by_paths", 1), more = choices_.earlier("more_paths", kMaxBeside);
  const NoisyPicture of_passes = passes_.with_noise(rest_),
                     of_paths{paths_->sent(), paths_->sent_difference()};
  passes_over_paths_ = pipeline::passes_over_paths(of_passes, passes.seconds, of_paths, paths_->seconds(),
                                                   paths_->light_paths() > 0);
  const bool better = by_paths ? *by_paths == 1
                               : passes_over_paths_ > 1 && missed_light(of_passes, of_paths) < kMissedByPaths;
  choices_.record("by_paths", better ? 1 : 0);
  char ratio[32];
  std::snprintf(ratio, sizeof ratio, "%.2g", passes_over_paths_);
  sinks_.say(std::string("noise of passes, and light that they miss, over that of paths in the same time: ") +
             ratio + (better ? ", so paths go on" : ", so passes go on"));
  const int before = paths_->paths();
  bool whole = true;
  if (better) {
    own_emission_ = have_better_emission(is_smaller);
    choices_.record("own_emission", own_emission_ ? 1 : 0);
    picture_.go_on_by(*paths_, own_emission_);
    whole = go_on(more);
  }
  choices_.record("more_paths", paths_->paths() - before);
  if (better) choose_share(passes.seconds);
  return whole;
}

bool PathsAfterPasses::try_out(const View& view, const Passes& passes) {
  const auto earlier = choices_.earlier("trial_paths", kMaxBeside);
  const double pass = passes.seconds / passes.rounds,
               dear = std::max(kDearPath * pass, kDearOfLeft * left_());
  if (earlier ? *earlier == 0 : left_() < kWorthATrial * pass || rest_.seconds_of_whole_path(view) > dear)
    return true;
  paths_.emplace(world_, view, settings_, &choices_, sinks_);
  if (earlier) return paths_->add(static_cast<int>(*earlier), sinks_);
  if (!paths_->add(1, sinks_)) return false;
  if (paths_->seconds() > dear) {
    paths_.reset();
    return true;
  }
  for (int more = 1; more == 1 || paths_->seconds() < kPartOfTrial * passes.seconds; more = 2)
    if (!paths_->add(more, sinks_)) return false;
  return true;
}

// Than film samples apart, which go on with them then.
bool PathsAfterPasses::have_better_emission(bool is_smaller) {
  if (const auto earlier = choices_.earlier("own_emission", 1)) return *earlier == 1;
  if (is_smaller) return false;
  const double each = paths_->seconds() / paths_->paths();
  return !wanted_parts(settings_.view.only).emission ||
         own_emission_over_apart(*paths_, paths_->paths() + std::max(0.0, left_()) / each) < 1;
}

// Until the budget is over, or as many as an earlier run had.
bool PathsAfterPasses::go_on(std::optional<std::int64_t> earlier) {
  int check_error_at = kPathsForError;
  for (std::int64_t done = 0;;) {
    const double target = settings_.method.target_error;
    if (!earlier && target > 0 && paths_->paths() >= check_error_at) {
      if (picture_.noise(settings_.method.error_metric) < target) return true;
      check_error_at = static_cast<int>(kPathsToAskAgain * paths_->paths());
    }
    const double each = paths_->seconds() / paths_->paths();
    const std::int64_t wanted = earlier ? *earlier - done : paths_that_fit(left_(), each, settings_.time);
    if (wanted < 1) return true;
    const auto more =
        std::min(wanted, std::max<std::int64_t>(1, static_cast<std::int64_t>(kPathsAtOnce / each)));
    if (!paths_->add(static_cast<int>(more), sinks_)) return false;
    done += more;
    if (!own_emission_ && !add_features()) return false;
    shown_();
  }
}

// As many as the paths say, in whatever portions these came.
bool PathsAfterPasses::add_features() {
  constexpr int kPathsForOne = 8, kFirstNumber = 1 << 10;
  if (!passes_.denoising().traced()) return true;
  for (; features_ < paths_->paths() / kPathsForOne; ++features_)
    if (!passes_.trace_another(kFirstNumber + features_, sinks_)) return false;
  return true;
}

// Passes that are done count too, though paths go on.
void PathsAfterPasses::choose_share(double passes_seconds) {
  constexpr int kParts = 1000;
  const double share = share_of_passes(passes_over_paths_, passes_seconds, paths_->seconds());
  const auto earlier = choices_.earlier("share_of_passes", kParts);
  const std::int64_t parts = earlier ? *earlier : std::lround(kParts * share);
  choices_.record("share_of_passes", parts);
  picture_.set_share_of_passes(static_cast<float>(parts) / kParts);
}

}  // namespace lumirank::pipeline
