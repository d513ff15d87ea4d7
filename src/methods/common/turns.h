// Passes over row groups under a time budget: all row groups in every turn, from coarse to fine over the
// picture, until the time is spent.
//
// First every row gets a coarse estimate (coarse_picture.h). A few row groups at low quality tell what
// quality fits the time for all of them; with it goes the first turn. Later turns take what time is left, and
// each row group's estimates are averaged by the square of quality (errors fall about as it grows), or the
// finer one replaces the coarser. Where the last turn ends early, row groups that it did not reach keep what
// they have.
//
// Quality is a multiple of what the method does without a budget (in sixty-fourths: clusters, nodes, columns,
// 1/bound); time grows as a power of it. A budget that allows more than that is used, up to kMaxQuality.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "methods/common/coarse_picture.h"
#include "methods/common/row_group_pass.h"
#include "methods/common/timed_choices.h"

namespace lumirank::methods {

// Of a turn, and of all turns of a row group together: more would cost more than it shows.
inline constexpr double kMaxQualityOfTurn = 8, kMaxQuality = 64;

struct Turn {
  double quality = 1;        // 1: the method's own
  std::uint64_t number = 0;  // of independent turns: 0 without a budget
  bool first() const { return number == 0; }
  // A number of something at this quality, at least `least`.
  std::size_t scaled(std::size_t count, std::size_t min_count = 1) const;
};

struct TurnMethod {
  const char* phase = "columns";
  // Estimates of different turns are independent and of no structure that a finer one would be rid of: they
  // are averaged. Otherwise each turn is twice as fine as the one before it, at least.
  bool averaged = true;
  double entries_per_row = 500;  // of quality 1, roughly: for a first guess of what a row group takes
  double exact_from = 0;         // quality from which row groups are exact; 0: none is
  double min_quality = 0;        // quality that there is, if more than a sixty-fourth
  double of_own = 1;             // what quality 1 is of the method's own, where it was cut to the time before
  std::function<void(const Turn&)> prepare{};  // before a turn and before its trials; may be empty
};

class Turns {
 public:
  // A covered pass: see RowGroupControl.
  using Pass = std::function<RowGroupResult(const RowGroupControl&, const Turn&, std::span<Rgb> out)>;
  // Some row groups of `order` side by side.
  using Trial =
      std::function<void(std::span<const std::uint32_t> row_groups, const Turn&, std::span<Rgb> out)>;

  // Under a budget writes a coarse picture of all rows.
  Turns(const matrix::LightingMatrix& matrix, const RunOptions& options, const RunClock& clock,
        std::span<Rgb> sums)
      : matrix_(matrix), options_(options), clock_(clock) {
    if (options.time_seconds > 0) coarse_ = make_coarse_picture(matrix, options, clock, sums);
  }
  RowGroupResult run(const RowGroups& row_groups, const TurnMethod& method, std::span<Rgb> sums,
                     const Pass& pass, const Trial& trial);
  // "turns", "turn_quality", "budget.coarse_share" and, where less than the method's own quality was had for
  // some of it, "budget.seconds_wanted".
  void write(Trace& trace) const;

 private:
  double first_quality(const RowGroups& row_groups, const TurnMethod& method, const Trial& trial,
                       std::span<Rgb> out);
  // The quality whose turn takes so long, by the last one.
  double fitting_in(double seconds) const;
  double next_quality(const TurnMethod& method) const;
  RowGroupResult run_turn(const RowGroups& row_groups, const TurnMethod& method, const Turn& turn,
                          std::span<Rgb> sums, const Pass& pass);

  const matrix::LightingMatrix& matrix_;
  const RunOptions& options_;
  const RunClock& clock_;
  CoarsePicture coarse_;
  std::vector<Rgb> fresh_;
  std::vector<double> quality_;  // by row group: of what its sums are
  double coarse_quality_ = 0;    // what the coarse picture is worth beside turns
  double begin_ = 0;             // of the first turn's trials
  double last_quality_ = 0;      // of a turn, and what it took for all row groups
  double last_seconds_ = 0, group_seconds_ = 0;
  double power_ = 1;  // of quality, that seconds are in proportion to
  std::size_t turns_ = 0;
  double coarse_share_ = 1, min_quality_ = 0, mean_quality_ = 0, seconds_wanted_ = 0;
};

// Turns of body(group, workspace, turn, out), which writes out[i] of the row group's rows; without a budget
// one pass of quality 1 that writes `sums`.
template <typename Workspace, typename Body>
RowGroupResult run_in_turns(Turns& turns, const RowGroups& row_groups, const RowGroupControl& control,
                            const TurnMethod& method, std::span<Rgb> sums, WorkspacePool<Workspace>& pool,
                            Body&& body) {
  if (control.options.time_seconds <= 0) {
    if (method.prepare) method.prepare({});
    return run_row_groups(row_groups, control, sums, pool,
                          [&](std::size_t group, Workspace& w) { body(group, w, Turn{}, sums); });
  }
  return turns.run(
      row_groups, method, sums,
      [&](const RowGroupControl& of_turn, const Turn& turn, std::span<Rgb> out) {
        // `out` may be where fresh estimates go before they are taken in: on_group does that.
        return run_row_groups(row_groups, of_turn, sums, pool, [&](std::size_t group, Workspace& w) {
          body(group, w, turn, out);
          of_turn.on_group(group);
        });
      },
      [&](std::span<const std::uint32_t> some, const Turn& turn, std::span<Rgb> out) {
        parallel_for(some.size(), 1, [&](std::size_t begin, std::size_t end) {
          typename WorkspacePool<Workspace>::Lease w(pool);
          for (std::size_t k = begin; k < end; ++k) body(some[k], *w, turn, out);
        });
      });
}

}  // namespace lumirank::methods
