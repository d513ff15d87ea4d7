// One run over all slices of a matrix: slices, light tree, error and trace, and the turns of a time budget.
// What happens in a slice is the method's.
#pragma once

#include <optional>

#include "methods/common/exact_rows.h"
#include "methods/common/light_tree/light_tree.h"
#include "methods/common/row_group_pass.h"
#include "methods/common/slices/slices.h"
#include "methods/common/turns.h"
#include "methods/slice_cuts/level_search.h"
#include "methods/slice_cuts/slice_tally.h"

namespace lumirank::methods {

// Of a slice's random numbers.
std::uint64_t slice_key(std::uint64_t seed, std::size_t slice, std::uint64_t turn = 0);

// Most receivers of a slice of `slice_rows` pixels: slices are cut by receivers, of which a pixel has
// several. Where little of the picture is to be lit, those of the usual size are too few to be refined by the
// clock: a turn ends with some of them. So `timed` slices are smaller, unless the size was set by hand.
std::size_t max_slice_receivers(const matrix::LightingMatrix& matrix, std::size_t slice_rows, bool timed);

class SliceRun {
 public:
  SliceRun(const matrix::LightingMatrix& matrix, const RunOptions& options, const SliceCutSettings& settings);

  const LightTree& tree() const { return *tree_; }
  const Slices& slices() const { return slices_; }
  // The level that meets the target. Nothing where there is nothing to try, and with a time budget, where the
  // time decides. settings_of(level); predicts: whether levels of visibility differ.
  template <typename Slice, typename SettingsOf>
  std::optional<LevelChoice> search(WorkspacePool<Slice>& pool, bool predicts, SettingsOf&& settings_of) {
    if (options_.time_seconds > 0) return std::nullopt;
    return search({predicts, [&](const SliceLevel& level, std::size_t s, std::span<Rgb> sums) {
                     typename WorkspacePool<Slice>::Lease lease(pool);
                     Slice& slice = *lease;
                     const double before = slice.tally().cost();
                     slice.run(settings_of(level), slices_.slice(s), slice_key(options_.seed, s), sums);
                     return slice.tally().cost() - before;
                   }});
  }
  // slice.run(settings, receivers, key, sums) for all slices, each by one of the pool's work spaces, where
  // `settings` are refined for every turn. exact: whether refined settings end in the sum of all columns.
  template <typename Slice, typename Settings>
  void run(const Settings& settings, bool exact, WorkspacePool<Slice>& pool) {
    const std::size_t columns = std::min(settings.initial_columns, settings.max_columns);
    TurnMethod method{.phase = "slices", .entries_per_row = static_cast<double>(settings.initial_columns)};
    if (exact && columns > 0)
      method.exact_from = static_cast<double>(matrix_.columns()) / static_cast<double>(columns);
    const RowGroups row_groups(slices_.rows, slices_.first);
    result_ =
        run_in_turns(turns_, row_groups, {options_, clock_, 0, method.phase}, method, estimate_.sums, pool,
                     [&](std::size_t s, Slice& slice, const Turn& turn, std::span<Rgb> sums) {
                       Settings of_turn = settings;
                       of_turn.refine(turn);
                       slice.run(of_turn, slices_.slice(s), slice_key(options_.seed, s, turn.number), sums);
                     });
  }
  Trace& trace() { return estimate_.trace; }
  // The estimate with its error and what the run itself has to report.
  Estimate finish(const SliceTally& tally);

 private:
  std::optional<LevelChoice> search(const LevelTrials& trials);

  const matrix::LightingMatrix& matrix_;
  const RunOptions& options_;
  const RunClock clock_;
  Estimate estimate_;
  Turns turns_;
  RowsForError rows_;
  std::optional<LightTree> tree_;
  Slices slices_;
  RowGroupResult result_;
};

}  // namespace lumirank::methods
