// Shared by methods with columns of their own for every slice: rows, clusters, the pass over slices, and what
// the trace says of them.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/timer.h"
#include "methods/common/exact_rows.h"
#include "methods/common/row_group_pass.h"
#include "methods/common/slices/slice_lights.h"
#include "methods/common/turns.h"

namespace lumirank::methods {

// Of one thread's slices.
struct SliceCosts {
  double seconds_clustering = 0, seconds_columns = 0;
  std::uint64_t entries = 0, max_columns = 0;
};

// Sums, progress, previews and costs of a run, without what happens in a slice.
class SlicePass {
 public:
  SlicePass(const matrix::LightingMatrix& matrix, const RunOptions& options,
            const SliceLightSettings& settings);

  // body(slice, workspace) for all slices. A Workspace has `lights`, of which a slice's columns are chosen
  // before it, and `costs`.
  template <typename Workspace, typename Body>
  void run(WorkspacePool<Workspace>& pool, Body&& body) {
    if (!lights_.ready()) return;
    const RowGroups row_groups(lights_.slices().rows, lights_.slices().first);
    const auto render = [&](std::size_t s, Workspace& w, const Turn&, std::span<Rgb> sums) {
      const Timer timer;
      lights_.choose(s, w.lights);
      const double chosen = timer.seconds();
      body(lights_, s, w, sums);
      const std::size_t columns = w.lights.chosen.size();
      w.costs.entries += columns * lights_.slices().slice(s).size();
      w.costs.max_columns = std::max<std::uint64_t>(w.costs.max_columns, columns);
      w.costs.seconds_clustering += chosen;
      w.costs.seconds_columns += timer.seconds() - chosen;
    };
    const std::size_t columns = std::min(lights_.columns(), matrix_.columns());
    const auto own = static_cast<double>(std::max<std::size_t>(columns, 1));
    TurnMethod method{.entries_per_row = own};
    if (options_.time_seconds > 0) {
      method.min_quality = std::min(1.0, static_cast<double>(lights_.min_columns()) / own);
      method.exact_from = static_cast<double>(matrix_.columns()) / own;
      method.of_own = own / static_cast<double>(std::max<std::size_t>(given_columns_, 1));
      method.prepare = [&, columns](const Turn& turn) {
        lights_.set_turn(turn.scaled(columns), turn.number);
      };
    }
    result_ = run_in_turns(turns_, row_groups, {options_, clock_, 0, "columns"}, method, estimate_.sums, pool,
                           render);
    costs_ = costs_of(pool);
  }
  Estimate finish();

 private:
  template <typename Workspace>
  static SliceCosts costs_of(const WorkspacePool<Workspace>& pool) {
    SliceCosts all;
    pool.for_each([&](const Workspace& w) {
      all.seconds_clustering += w.costs.seconds_clustering;
      all.seconds_columns += w.costs.seconds_columns;
      all.entries += w.costs.entries;
      all.max_columns = std::max(all.max_columns, w.costs.max_columns);
    });
    return all;
  }

  const matrix::LightingMatrix& matrix_;
  const RunOptions& options_;
  RunClock clock_;
  Estimate estimate_;
  Turns turns_;
  RowsForError rows_;
  std::vector<Rgb> row_sums_;  // of slices, where rows have an estimate already
  SliceLights lights_;
  std::size_t given_columns_;
  RowGroupResult result_;
  SliceCosts costs_;
};

template <typename Workspace, typename Body>
Estimate run_slices(const matrix::LightingMatrix& matrix, const RunOptions& options,
                    const SliceLightSettings& settings, WorkspacePool<Workspace>& pool, Body&& body) {
  SlicePass pass(matrix, options, settings);
  pass.run(pool, std::forward<Body>(body));
  return pass.finish();
}

}  // namespace lumirank::methods
