#include "methods/common/turns.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumirank::methods {

using matrix::Index;

namespace {

constexpr double kSteps = 64;  // of quality: what a choice counts in
// Of the time that is left: what the first turn plans with, so that all row groups have it though trials are
// few; the later ones, which know better; what a trial may take; and below what nothing more is begun.
constexpr double kFirstTurn = 0.5, kLaterTurn = 0.95, kTrials = 0.06, kNothingLeft = 0.02;
constexpr std::size_t kTriedByThread = 4;
// Columns drawn by power tell a row less than as many that are chosen for it; and beside a turn that is many
// times better the coarse picture is left out.
constexpr double kCoarseWorth = 1.0 / 8, kCoarseCounts = 1.0 / 16;
// Seconds grow as a power of quality between these, as trials show: parts of a row group's costs are fixed.
constexpr double kMinPower = 0.4;
constexpr double kTrialStep = 4, kTrialSafety = 1.5;
// A first guess of what an entry costs a method, in entries of the coarse picture.
constexpr double kDearer = 3;
constexpr double kUsualEntries = 500;  // of a row, where the method was not asked
constexpr double kNearlyWhole = 0.95;  // of the method's own quality: no more time is wanted
// What is wanted is asked with some reserve: costs differ from row group to row group.
constexpr double kReserve = 1.2;

std::int64_t steps_of(double quality) {
  return static_cast<std::int64_t>(std::clamp(std::floor(quality * kSteps), 0.0, kSteps * kMaxQualityOfTurn));
}

}  // namespace

std::size_t Turn::scaled(std::size_t count, std::size_t min_count) const {
  if (quality == 1) return count;
  const double scaled = std::min(quality * static_cast<double>(count), 1e15);
  return std::max(static_cast<std::size_t>(std::llround(scaled)), min_count);
}

// A row group for each thread at rising quality, as long as the next trial is short beside the time that is
// left.
double Turns::first_quality(const RowGroups& row_groups, const TurnMethod& method, const Trial& trial,
                            std::span<Rgb> out) {
  const double deadline = deadline_of(options_);
  const std::vector<std::uint32_t> order = coarse_to_fine(row_groups.size());
  double quality = std::clamp(std::ceil(method.min_quality * kSteps), 1.0, kSteps) / kSteps;
  const double min_quality = quality;
  const double left_at_first = deadline - clock_.seconds();
  // Some row groups for each thread, since they differ; one if that is dear.
  const auto threads = static_cast<std::size_t>(current_threads());
  std::size_t tried = 0;
  double guess = 0;
  for (const std::size_t each : {kTriedByThread, std::size_t{1}}) {
    tried = std::min(row_groups.size(), each * threads);
    std::size_t rows = 0;
    for (std::size_t k = 0; k < tried; ++k) rows += row_groups[order[k]].size();
    guess = kDearer * quality * method.entries_per_row * static_cast<double>(rows) * coarse_.entry_seconds;
    if (guess < kTrials * left_at_first) break;
  }
  const auto some = std::span(order).first(tried);
  const double turns = static_cast<double>(row_groups.size()) / static_cast<double>(tried);
  const double side_by_side = static_cast<double>(std::min(tried, threads)) / static_cast<double>(tried);
  if (guess > left_at_first || left_at_first <= 0) {
    group_seconds_ = guess * side_by_side;
    last_quality_ = quality, last_seconds_ = guess * turns;
    return 0;
  }
  double fitting = 0;
  for (;;) {
    const Turn turn{quality, 0};
    if (method.prepare) method.prepare(turn);
    const double before = clock_.seconds();
    trial(some, turn, out);
    const double took = std::max(clock_.seconds() - before, 1e-12), left = deadline - clock_.seconds();
    if (last_quality_ > 0)
      power_ = std::clamp(std::log(took * turns / last_seconds_) / std::log(quality / last_quality_),
                          kMinPower, 1.0);
    group_seconds_ = took * side_by_side;
    last_quality_ = quality, last_seconds_ = took * turns;
    // Not far beyond what was tried.
    fitting = std::min(fitting_in(kFirstTurn * left), 2 * kTrialStep * quality);
    const double next = std::min(quality * kTrialStep, 1.0);
    if (quality >= 1 || fitting < next || took * kTrialSafety * next / quality > kTrials * left) break;
    quality = next;
  }
  // Even the lowest quality may be too dear for all row groups; as many as there is time for have it.
  return std::max(fitting, min_quality);
}

double Turns::fitting_in(double seconds) const {
  return last_quality_ * std::pow(std::max(seconds, 0.0) / std::max(last_seconds_, 1e-12), 1 / power_);
}

// As much as the time that is left allows for all row groups, by what the last turn took; or for some of
// them.
double Turns::next_quality(const TurnMethod& method) const {
  const double left = deadline_of(options_) - clock_.seconds();
  if (left < kNothingLeft * options_.time_seconds) return 0;
  const double fitting = fitting_in(kLaterTurn * left);
  const double next =
      method.averaged ? std::max(fitting, last_quality_ / 2) : std::max(fitting, 2 * last_quality_);
  return std::max(next, std::max(1 / kSteps, std::ceil(method.min_quality * kSteps) / kSteps));
}

RowGroupResult Turns::run_turn(const RowGroups& row_groups, const TurnMethod& method, const Turn& turn,
                               std::span<Rgb> sums, const Pass& pass) {
  if (method.prepare) method.prepare(turn);
  RowGroupControl control{options_, clock_, deadline_of(options_), method.phase};
  control.covered = true;
  control.group_seconds =
      last_quality_ > 0 ? group_seconds_ * std::max(1.0, turn.quality / last_quality_) : group_seconds_;
  const bool replaces = !method.averaged || (method.exact_from > 0 && turn.quality >= method.exact_from);
  control.on_group = [&](std::size_t group) {
    double& have = quality_[group];
    const double before = have > 0                                         ? have
                          : coarse_quality_ < kCoarseCounts * turn.quality ? 0
                                                                           : coarse_quality_;
    const auto share =
        static_cast<float>(replaces || before == 0 ? 1.0
                                                   : turn.quality * turn.quality /
                                                         (before * before + turn.quality * turn.quality));
    for (const Index i : row_groups[group])
      sums[i] = share >= 1 ? fresh_[i] : lerp(sums[i], fresh_[i], share);
    have = replaces ? turn.quality : std::hypot(have, turn.quality);
  };
  const double before = clock_.seconds();
  const RowGroupResult result = pass(control, turn, fresh_);
  if (result.done > 0) {
    const double share = static_cast<double>(result.done) / static_cast<double>(row_groups.size());
    last_seconds_ = (clock_.seconds() - before) / share;
    last_quality_ = turn.quality;
    group_seconds_ =
        last_seconds_ * static_cast<double>(current_threads()) / static_cast<double>(row_groups.size());
    ++turns_;
  }
  return result;
}

RowGroupResult Turns::run(const RowGroups& row_groups, const TurnMethod& method, std::span<Rgb> sums,
                          const Pass& pass, const Trial& trial) {
  RowGroupResult result;
  quality_.assign(row_groups.size(), 0.0);
  begin_ = clock_.seconds();
  result.cancelled = options_.sinks.cancelled();
  if (row_groups.size() == 0 || result.cancelled) return result;
  fresh_.assign(sums.size(), Rgb(0));
  if (coarse_.all_rows_read)
    coarse_quality_ = kCoarseWorth * static_cast<double>(coarse_.columns) / method.entries_per_row;
  const auto max_steps = static_cast<std::int64_t>(kSteps * kMaxQualityOfTurn);
  double spent = 0;
  for (std::uint64_t number = 0; spent < kMaxQuality; ++number) {
    const std::int64_t steps = timed_choice(options_, "turn_quality", max_steps, [&]() -> std::int64_t {
      return steps_of(number == 0 ? first_quality(row_groups, method, trial, fresh_) : next_quality(method));
    });
    if (steps == 0) {
      result.out_of_time = true;
      break;
    }
    const Turn turn{static_cast<double>(steps) / kSteps, number};
    result = run_turn(row_groups, method, turn, sums, pass);
    spent += turn.quality;
    if (options_.on_estimate && result.done > 0) options_.on_estimate(sums);
    if (result.cancelled) break;
    // A lower quality may still fit, where estimates are averaged.
    if (result.out_of_time && (result.done == 0 || !method.averaged)) break;
    if (!method.averaged && turn.quality >= kMaxQualityOfTurn) break;
    if (method.exact_from > 0 && turn.quality >= method.exact_from) break;
  }
  result.seconds = clock_.seconds() - begin_;

  std::size_t coarse = 0;
  double whole = 0;
  min_quality_ = kMaxQuality;
  for (std::size_t u = 0; u < row_groups.size(); ++u) {
    const auto rows = static_cast<double>(row_groups[u].size());
    if (quality_[u] == 0) coarse += row_groups[u].size();
    min_quality_ = std::min(min_quality_, quality_[u]);
    whole += rows, mean_quality_ += rows * quality_[u];
  }
  coarse_share_ = static_cast<double>(coarse) / whole;
  mean_quality_ /= whole;
  const double whole_quality = kNearlyWhole / method.of_own;
  const bool exact = method.exact_from > 0 && min_quality_ >= method.exact_from;
  if (min_quality_ < whole_quality && !exact && !result.cancelled && last_quality_ > 0)
    seconds_wanted_ = (begin_ + last_seconds_ * std::pow(1 / last_quality_, power_) / kFirstTurn) /
                      method.of_own * kReserve;
  // Told by the qualities; it is the rule that the last turn ends early.
  result.out_of_time = min_quality_ < whole_quality && !exact && !result.cancelled;
  return result;
}

void Turns::write(Trace& trace) const {
  if (options_.time_seconds <= 0) return;
  auto& numbers = trace.numbers;
  numbers["coarse.columns"] = static_cast<double>(coarse_.columns);
  numbers["turns"] = static_cast<double>(turns_);
  numbers["turn_quality"] = mean_quality_;
  numbers["budget.coarse_share"] = coarse_share_;
  // Where the time did not suffice to try a row group, by the coarse picture.
  const double guess = kDearer * kUsualEntries * static_cast<double>(matrix_.rows()) * coarse_.entry_seconds;
  const double wanted = turns_ == 0 && seconds_wanted_ == 0 ? guess : seconds_wanted_;
  if (wanted > 0) numbers["budget.seconds_wanted"] = std::max(wanted, 1.05 * options_.time_seconds);
}

}  // namespace lumirank::methods
