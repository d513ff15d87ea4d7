// A pass over groups of rows that know nothing of each other: receivers, pixels, slices. Row groups run side
// by side, each on one thread, with work space that is kept; between them come progress, previews, the
// deadline and cancellation.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "methods/common/run_clock.h"
#include "methods/method.h"

namespace lumirank::methods {

// Rows divided among row groups; a row belongs to one row group at most.
class RowGroups {
 public:
  // Row group u has rows[first[u]] … rows[first[u + 1] − 1], none of them empty: first has one number more
  // than there are row groups.
  RowGroups(std::vector<matrix::Index> rows, std::vector<std::uint32_t> first);
  // Every row on its own.
  static RowGroups single(std::size_t rows);
  // The rows of a pixel together (RowFeatures::pixel), in the order of their first rows; every row on its own
  // where film positions are unknown.
  static RowGroups pixels(const matrix::LightingMatrix& matrix);

  std::size_t size() const { return first_.size() - 1; }
  std::span<const matrix::Index> operator[](std::size_t group) const {
    return std::span(rows_).subspan(first_[group], first_[group + 1] - first_[group]);
  }

 private:
  std::vector<matrix::Index> rows_;
  std::vector<std::uint32_t> first_;
};

// The row groups 0 … count − 1 from coarse to fine: every beginning is spread evenly over all of them.
std::vector<std::uint32_t> coarse_to_fine(std::size_t count);

// Work spaces, as many as threads ever needed one at a time. Which of them a row group gets is chance: a work
// space must not carry anything from row group to row group but sums that do not depend on their order.
template <typename Workspace>
class WorkspacePool {
 public:
  using Factory = std::function<std::unique_ptr<Workspace>()>;
  explicit WorkspacePool(Factory make) : make_(std::move(make)) {}

  class Lease {
   public:
    explicit Lease(WorkspacePool& pool) : pool_(pool) {
      {
        const std::lock_guard lock(pool.mutex_);
        if (!pool.spare_.empty()) {
          held_ = std::move(pool.spare_.back());
          pool.spare_.pop_back();
        }
      }
      if (!held_) held_ = pool.make_();
    }
    ~Lease() {
      const std::lock_guard lock(pool_.mutex_);
      pool_.spare_.push_back(std::move(held_));
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    Workspace& operator*() { return *held_; }

   private:
    WorkspacePool& pool_;
    std::unique_ptr<Workspace> held_;
  };

  // Of those that are not leased: all of them, once the pass is over.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (const auto& workspace : spare_) visit(*workspace);
  }

 private:
  Factory make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> spare_;
};

struct RowGroupControl {
  const RunOptions& options;
  const RunClock& timer;         // since the method was called
  double deadline = 0;           // seconds of `timer` after which no row group is begun; 0: none
  const char* phase = "pixels";  // what progress is called
  // All rows have an estimate, which those of row groups that are not reached keep: none need be reached.
  bool covered = false;
  double group_seconds =
      0;  // what a row group is expected to take, until the first ones are done; 0: unknown
  std::function<void(std::size_t group)> on_group{};  // for the callers of turns.h: a row group is done
};

struct RowGroupResult {
  std::size_t done = 0;  // row groups: the first `done` of coarse_to_fine()
  bool cancelled = false;
  bool out_of_time = false;
  double seconds = 0;
};

// What row groups like those before may take, all threads at work: against a deadline.
class RowGroupSeconds {
 public:
  explicit RowGroupSeconds(double expected) : expected_(expected) {}
  void add(double seconds) {
    sum_ += seconds, ++count_;
    longest_ = std::max(longest_, seconds);
  }
  // Half way from the mean to the longest: a row group like the longest is met once in a while.
  double next() const {
    return count_ > 0 ? 0.5 * (sum_ / static_cast<double>(count_) + longest_) : expected_;
  }

 private:
  double expected_, sum_ = 0, longest_ = 0;
  std::size_t count_ = 0;
};

// Whose turn it is; nothing once the pass is over.
using NextRowGroup = std::function<std::optional<std::size_t>()>;
// Calls worker(next) on all threads; each asks for row groups until there are none. What a worker has taken
// it finishes, and then has written (not added to) sums[i] of all rows i of the row group. Where the pass
// ends early and rows are not covered, rows of other row groups take the sum of the nearest row that is
// finished (by number: rows are kept in an order in which neighbors lie close), and so do previews. Rows of
// no row group are left alone.
RowGroupResult run_workers(const RowGroups& row_groups, const RowGroupControl& control, std::span<Rgb> sums,
                           const std::function<void(const NextRowGroup&)>& worker);

// The same with body(group, workspace).
template <typename Workspace, typename Body>
RowGroupResult run_row_groups(const RowGroups& row_groups, const RowGroupControl& control,
                              std::span<Rgb> sums, WorkspacePool<Workspace>& pool, Body&& body) {
  return run_workers(row_groups, control, sums, [&](const NextRowGroup& next) {
    typename WorkspacePool<Workspace>::Lease workspace(pool);
    while (const auto group = next()) body(*group, *workspace);
  });
}

// Estimate::interrupted and the note "stopped", if it was.
void note_stop(const RowGroupResult& result, Estimate& estimate);

}  // namespace lumirank::methods
