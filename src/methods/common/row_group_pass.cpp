#include "methods/common/row_group_pass.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "methods/common/timed_choices.h"

namespace lumirank::methods {

using matrix::Index;

RowGroups::RowGroups(std::vector<Index> rows, std::vector<std::uint32_t> first)
    : rows_(std::move(rows)), first_(std::move(first)) {
  if (first_.empty() || first_.front() != 0 || first_.back() != rows_.size())
    throw InternalError("methods::RowGroups: groups do not cover the rows given");
  if (std::adjacent_find(first_.begin(), first_.end(), std::greater_equal<>()) != first_.end())
    throw InternalError("methods::RowGroups: a group without rows");
}

RowGroups RowGroups::single(std::size_t rows) {
  std::vector<Index> all(rows);
  std::iota(all.begin(), all.end(), 0u);
  std::vector<std::uint32_t> first(rows + 1);
  std::iota(first.begin(), first.end(), 0u);
  return {std::move(all), std::move(first)};
}

RowGroups RowGroups::pixels(const matrix::LightingMatrix& matrix) {
  const auto film = matrix.row_features().pixel;
  if (film.empty()) return single(matrix.rows());
  struct Placed {
    std::int32_t x, y;
    Index row;
    Index first = 0;  // of its pixel
  };
  std::vector<Placed> placed(film.size());
  for (std::size_t i = 0; i < film.size(); ++i)
    placed[i] = {static_cast<std::int32_t>(std::floor(film[i].x)),
                 static_cast<std::int32_t>(std::floor(film[i].y)), static_cast<Index>(i)};
  parallel_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.y != b.y ? a.y < b.y : a.x != b.x ? a.x < b.x : a.row < b.row;
  });
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const bool same = k > 0 && placed[k].x == placed[k - 1].x && placed[k].y == placed[k - 1].y;
    placed[k].first = same ? placed[k - 1].first : placed[k].row;
  }
  parallel_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.first != b.first ? a.first < b.first : a.row < b.row;
  });
  std::vector<Index> rows;
  std::vector<std::uint32_t> first;
  for (const Placed& p : placed) {
    if (p.first == p.row) first.push_back(static_cast<std::uint32_t>(rows.size()));
    rows.push_back(p.row);
  }
  first.push_back(static_cast<std::uint32_t>(rows.size()));
  return {std::move(rows), std::move(first)};
}

namespace {

constexpr int kBits = 6;
constexpr std::size_t kStrides = 1u << kBits;

std::size_t reversed(std::size_t k) {
  std::size_t r = 0;
  for (int bit = 0; bit < kBits; ++bit) r |= ((k >> bit) & 1u) << (kBits - 1 - bit);
  return r;
}

// Previews after these shares of the row groups. Before each of them all threads wait for the last row group,
// so they are few.
constexpr double kPreviews[] = {1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2, 3.0 / 4};

// Hands out row groups in order and keeps an eye on what may end the pass.
class WorkQueue {
 public:
  WorkQueue(std::span<const std::uint32_t> order, const RowGroupControl& control)
      : order_(order),
        control_(control),
        start_(control.timer.seconds()),
        group_seconds_(control.group_seconds) {
    if (TimedChoices* choices = choices_of(control.options))
      earlier_ = choices->earlier("units", static_cast<std::int64_t>(order.size()));
  }

  void open_until(std::size_t end) { end_ = end; }
  // began: when this worker's last row group was taken; < 0 before the first.
  std::optional<std::size_t> next(double& began) {
    const std::lock_guard lock(mutex_);
    if (control_.deadline > 0) {
      const double now = control_.timer.seconds();
      if (began >= 0) group_seconds_.add(now - began);
      began = now;
    }
    if (stopped() || taken_ >= end_) return std::nullopt;
    if (control_.options.sinks.progress && taken_ >= reported_) {
      control_.options.sinks.report(control_.phase,
                                    static_cast<double>(taken_) / static_cast<double>(order_.size()));
      reported_ = taken_ + std::max<std::size_t>(1, order_.size() / 200);
    }
    return order_[taken_++];
  }
  // No more row groups: somebody failed.
  void close() {
    const std::lock_guard lock(mutex_);
    failed_ = true;
  }
  RowGroupResult result() const {
    return {taken_, cancelled_, out_of_time_, control_.timer.seconds() - start_};
  }
  bool stopped() {
    if (taken_ >= order_.size() || failed_) return true;
    cancelled_ = cancelled_ || control_.options.sinks.cancelled();
    if (earlier_) {
      out_of_time_ = taken_ >= static_cast<std::size_t>(*earlier_);
    } else if (control_.deadline > 0 && (taken_ > 0 || control_.covered) && !out_of_time_) {
      out_of_time_ = control_.timer.seconds() + group_seconds_.next() > control_.deadline;
    }
    return cancelled_ || out_of_time_;
  }

 private:
  std::span<const std::uint32_t> order_;
  const RowGroupControl& control_;
  double start_;
  RowGroupSeconds group_seconds_;
  std::optional<std::int64_t> earlier_;
  std::mutex mutex_;
  std::size_t taken_ = 0, end_ = 0, reported_ = 0;
  bool cancelled_ = false, out_of_time_ = false, failed_ = false;
};

enum class RowState : std::uint8_t { of_no_unit, waiting, finished };

// Every waiting row takes the sum of the nearest finished one; of two as near, the earlier.
void fill_in(std::span<const RowState> state, std::span<Rgb> sums) {
  const std::size_t n = state.size();
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> after(n, kNone);
  std::size_t nearest = kNone;
  for (std::size_t i = n; i-- > 0;) {
    if (state[i] == RowState::finished) nearest = i;
    after[i] = nearest;
  }
  nearest = kNone;
  for (std::size_t i = 0; i < n; ++i) {
    if (state[i] == RowState::finished) nearest = i;
    if (state[i] != RowState::waiting) continue;
    const std::size_t next = after[i];
    if (nearest == kNone && next == kNone) continue;
    const bool earlier = next == kNone || (nearest != kNone && i - nearest <= next - i);
    sums[i] = sums[earlier ? nearest : next];
  }
}

}  // namespace

std::vector<std::uint32_t> coarse_to_fine(std::size_t count) {
  std::vector<std::uint32_t> order;
  order.reserve(count);
  for (std::size_t pass = 0; pass < kStrides; ++pass)
    for (std::size_t u = reversed(pass); u < count; u += kStrides)
      order.push_back(static_cast<std::uint32_t>(u));
  return order;
}

RowGroupResult run_workers(const RowGroups& row_groups, const RowGroupControl& control, std::span<Rgb> sums,
                           const std::function<void(const NextRowGroup&)>& worker) {
  const std::vector<std::uint32_t> order = coarse_to_fine(row_groups.size());
  std::vector<RowState> state(sums.size(), RowState::of_no_unit);
  for (std::size_t u = 0; u < row_groups.size(); ++u)
    for (const Index i : row_groups[u]) state[i] = RowState::waiting;

  WorkQueue dispenser(order, control);
  std::size_t marked = 0;
  const auto mark_finished = [&](std::size_t done) {
    for (; marked < done; ++marked)
      for (const Index i : row_groups[order[marked]]) state[i] = RowState::finished;
  };
  const auto run_until = [&](std::size_t end) {
    dispenser.open_until(end);
    parallel_for(static_cast<std::size_t>(current_threads()), 1, [&](std::size_t, std::size_t) {
      try {
        double began = -1;
        worker([&] { return dispenser.next(began); });
      } catch (...) {
        dispenser.close();
        throw;
      }
    });
    mark_finished(dispenser.result().done);
  };

  if (control.options.on_estimate)
    for (const double share : kPreviews) {
      const auto end = static_cast<std::size_t>(std::ceil(share * static_cast<double>(order.size())));
      if (end >= order.size()) break;
      run_until(end);
      if (dispenser.stopped()) break;
      if (dispenser.result().done == 0) continue;
      if (!control.covered) fill_in(state, sums);
      control.options.on_estimate(sums);
    }
  if (!dispenser.stopped()) run_until(order.size());
  RowGroupResult result = dispenser.result();
  result.cancelled = result.cancelled && result.done < order.size();
  result.out_of_time = result.out_of_time && result.done < order.size();
  if (TimedChoices* choices = choices_of(control.options))
    choices->record("units", static_cast<std::int64_t>(result.done));
  if (result.done < order.size() && !control.covered) fill_in(state, sums);
  control.options.sinks.report(
      control.phase,
      order.empty() ? 1.0 : static_cast<double>(result.done) / static_cast<double>(order.size()));
  return result;
}

void note_stop(const RowGroupResult& result, Estimate& estimate) {
  estimate.interrupted = result.cancelled;
  if (result.cancelled || result.out_of_time)
    estimate.trace.notes["stopped"] = result.cancelled ? "cancelled" : "time budget";
}

}  // namespace lumirank::methods
