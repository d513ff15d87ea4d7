// Automatic numbers of rows and columns: the second half of RowColumnRun.
#include <algorithm>
#include <cmath>

#include "methods/common/timed_choices.h"
#include "methods/row_column/run.h"

namespace lumirank::methods {

namespace {

constexpr std::size_t kFirstRows = 100;
constexpr std::size_t kMaxRowsRead = 4096;
constexpr std::size_t kHoldOut = 5;  // one row in so many
constexpr std::size_t kPilotColumns = 48;
constexpr std::size_t kMaxPasses = 5;
// Without a target or a time: see kUnaskedTarget.
constexpr std::size_t kMaxColumnsUnasked = 3000;
// A target for the whole error is held against what was measured at held-out rows, one draw of a random
// error: aimed a little lower, it is met more often than not.
constexpr double kAimBelow = 0.9;
// Held out before the first pass where an error is asked for.
constexpr std::size_t kHeldOutForTarget = 64;
// Held-out rows measure one draw of a random error on few rows: only clearly more than the target is a
// disagreement.
constexpr double kDisagreement = 1.5;
// Share of the time that a plan spends; the rest is for what the plan does not see.
constexpr double kPlannedTime = 0.94;

}  // namespace

double RowColumnRun::sampling_target() const {
  if (options_.target_error <= 0) return target_;
  const ErrorParts parts = errors();
  return kAimBelow * target_for_sampling(target_, parts.lights.value, parts.clamping.value);
}

double RowColumnRun::needed_error() const {
  const double target = sampling_target();
  if (target <= 0) return 0;
  const double have = blend_.expected_error();
  const double missing = 1 / (target * target) - (have > 0 ? 1 / (have * have) : 0.0);
  // The next pass may not be asked for less than half of the work: what the held-out rows disagree with is
  // not trusted.
  return 1 / std::sqrt(std::max(missing, 0.5 / (target * target)));
}

bool RowColumnRun::target_met() const {
  const double aim = sampling_target();
  if (aim <= 0 || blend_.expected_error() > aim * 1.001) return false;
  const ErrorParts parts = errors();
  if (options_.target_error <= 0) return parts.sampling.value <= kDisagreement * aim;
  // Where the other parts leave too little, only what is aimed for can be met.
  return parts.total().value <= target_ || parts.sampling.value <= aim;
}

ErrorCurve RowColumnRun::error_curve(ColumnClusters& known, double until_error) {
  ErrorCurve curve;
  const std::size_t max_clusters = std::max<std::size_t>(64, std::min<std::size_t>(columns_ / 2, 8192));
  linalg::Splitter clusters = known.cluster(1, linalg::ClusteringAlgorithm::splitting);
  for (std::size_t c = 32; c <= max_clusters; c *= 2) {
    const bool more = clusters.split_to(c);
    if (c == 256) known.tune_power_share(clusters, unseen_);
    curve.points.push_back(
        {static_cast<double>(c), known.expected_error(clusters), known.expected_error(clusters, unseen_)});
    if (!more || (until_error > 0 && curve.points.back().unseen <= until_error)) break;
    const auto too_late = [&] { return static_cast<double>(c) * costs().column > time_left(); };
    if (options_.time_seconds > 0 && timed_choice(options_, "curve_ends", 1, too_late)) break;
  }
  return curve;
}

void RowColumnRun::more_rows_while_they_pay(double needed) {
  double columns_before = 0;
  while (!stopped() && settings_.rows == 0 && rows_read() < std::min(kMaxRowsRead, rows_ / 4)) {
    const double start = timer_.seconds();
    ColumnClusters known(matrix_, seen_, settings_, options_.seed);
    const ErrorCurve curve = error_curve(known, needed);
    trace_.numbers["seconds.clustering"] += timer_.seconds() - start;
    const bool more = timed_choice(options_, "more_rows_pay", 1, [&] {
      bool pay = true;
      if (settings_.columns > 0) {
        // The number of columns is given: rows pay while unseen rows show more error than seen ones, and cost
        // less than columns.
        const auto c = static_cast<double>(settings_.columns);
        pay = curve.unseen(c) > 1.25 * curve.seen(c) &&
              static_cast<double>(rows_read()) * costs().row < 0.5 * c * costs().column;
      } else if (needed > 0) {
        const auto max_columns = static_cast<double>(columns_);
        pay = more_rows_pay_for_target(curve, {needed, rows_read(), max_columns, columns_before}, costs());
        columns_before = std::min(curve.columns_for_unseen(needed), max_columns);
      }
      if (options_.time_seconds > 0 && settings_.columns == 0)
        pay = pay && more_rows_pay_for_budget(curve, kPlannedTime * time_left(), rows_read(), costs());
      return pay;
    });
    if (!more) return;
    explore(sampler_.next(rows_read()), kHoldOut,
            options_.time_seconds > 0 ? timer_.seconds() + 0.6 * time_left() : 0);
    if (timed_choice(options_, "rows_end", 1, [&] { return time_left() < 0.3 * options_.time_seconds; }))
      return;
  }
}

linalg::Splitter RowColumnRun::cluster_for(ColumnClusters& known, double needed) {
  std::size_t max_columns = settings_.columns > 0 ? settings_.columns : columns_;
  const bool asked = options_.target_error > 0 || options_.time_seconds > 0;
  if (settings_.columns == 0 && !asked) max_columns = std::min(max_columns, kMaxColumnsUnasked);
  if (options_.time_seconds > 0 && settings_.columns == 0) {
    max_columns = timed_choice(options_, "affordable_columns", static_cast<std::int64_t>(max_columns), [&] {
      const double affordable = kPlannedTime * time_left() / costs().column / (1 + settings_.zero_share);
      return std::min(max_columns, static_cast<std::size_t>(std::max(affordable, 1.0)));
    });
  }
  if (settings_.columns > 0 || needed <= 0) {
    linalg::Splitter all = known.cluster(max_columns, settings_.clustering);
    known.tune_power_share(all, unseen_);
    return all;
  }

  // Splitting alone is quick and gives a first guess; the clustering that is used needs fewer columns.
  const ErrorCurve curve = error_curve(known, needed);
  const auto bounded = [&](double c) {
    return static_cast<std::size_t>(std::clamp(c, 1.0, static_cast<double>(max_columns)));
  };
  std::size_t c = bounded(0.7 * curve.columns_for_unseen(needed));
  linalg::Splitter clusters = known.cluster(c, settings_.clustering);
  known.tune_power_share(clusters, unseen_);
  for (int round = 0; round < 6; ++round) {
    const double error = known.expected_error(clusters, unseen_);
    if (error <= needed && (error >= 0.93 * needed || round >= 3)) break;
    if (error > needed && (c >= max_columns || clusters.clusters() < c)) break;  // no more can be had
    c = bounded(static_cast<double>(c) * std::clamp(1.02 * error / needed, 0.5, 2.0));
    clusters = known.cluster(c, settings_.clustering);
  }
  return clusters;
}

void RowColumnRun::pilot() {
  const ColumnClusters known(matrix_, seen_, settings_, options_.seed);
  const linalg::Splitter clusters =
      known.cluster(std::min(kPilotColumns, columns_ / 8), settings_.clustering);
  pass(known, clusters, known.expected_error(clusters, unseen_));
}

Estimate RowColumnRun::automatic() {
  if (target_ <= 0 && options_.time_seconds <= 0) target_ = kUnaskedTarget;
  // So few columns that searching for fewer costs more than rendering them.
  if (columns_ <= 2 * kPilotColumns) {
    pass_over_all_columns();
    return finish();
  }
  const std::size_t first =
      settings_.rows > 0 ? settings_.rows : std::min(kFirstRows, std::max<std::size_t>(rows_ / 4, 1));
  explore(sampler_.next(first), kHoldOut, 0.3 * options_.time_seconds);
  if (options_.target_error > 0 && settings_.rows == 0 && unseen_.rows() < kHeldOutForTarget)
    explore(sampler_.next(kHeldOutForTarget - unseen_.rows()), 1, 0.35 * options_.time_seconds);
  // A given number of columns is rendered once, and no others beside it.
  if (!stopped() && settings_.columns == 0) pilot();

  while (!stopped() && passes_ < kMaxPasses && (passes_ == 0 || !target_met())) {
    const double needed = needed_error();
    more_rows_while_they_pay(needed);
    if (stopped()) break;
    const double start = timer_.seconds();
    ColumnClusters known(matrix_, seen_, settings_, options_.seed + passes_);
    const linalg::Splitter clusters = cluster_for(known, needed);
    trace_.numbers["seconds.clustering"] += timer_.seconds() - start;
    const bool all_fit = timed_choice(options_, "all_columns_fit", 1, [&] {
      return options_.time_seconds <= 0 || costs().column * static_cast<double>(columns_) < time_left();
    });
    if (clusters.clusters() * 2 > columns_ && settings_.columns == 0 && all_fit) {
      pass_over_all_columns();
      break;
    }
    if (!pass(known, clusters, known.expected_error(clusters, unseen_))) break;
    if (settings_.columns > 0 || (options_.target_error <= 0 && options_.time_seconds <= 0)) break;
    if (timed_choice(options_, "passes_end", 1, [&] { return time_left() < 0.15 * options_.time_seconds; }))
      break;
    if (settings_.rows == 0 && !target_met())
      explore(sampler_.next_by_density(rows_read() / 2, blend_.disagreement()), 0,
              options_.time_seconds > 0 ? timer_.seconds() + 0.3 * time_left() : 0);
  }
  const bool met = options_.target_error > 0 ? errors().total().value <= target_ : target_met();
  if (target_ > 0 && !stopped() && !met) trace_.notes["target"] = "not reached";
  return finish();
}

}  // namespace lumirank::methods
