// What methods with columns of their own for every slice share: rows, clusters, the pass over slices, and
// what the trace says of them.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/timer.h"
#include "methods/slices/slice_lights.h"
#include "methods/timed_choices.h"
#include "methods/unit_pass.h"

namespace lumirank::methods {

// Of one thread's slices.
struct SliceCosts {
  double seconds_clustering = 0, seconds_columns = 0;
  std::uint64_t entries = 0, most_columns = 0;
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
    const UnitRows units(lights_.slices().rows, lights_.slices().first);
    const auto render = [&](std::size_t s, Workspace& w) {
      const Timer timer;
      lights_.choose(s, w.lights);
      const double chosen = timer.seconds();
      body(lights_, s, w, std::span<Rgb>(estimate_.sums));
      const std::size_t columns = w.lights.chosen.size();
      w.costs.entries += columns * lights_.slices().slice(s).size();
      w.costs.most_columns = std::max<std::uint64_t>(w.costs.most_columns, columns);
      w.costs.seconds_clustering += chosen;
      w.costs.seconds_columns += timer.seconds() - chosen;
    };
    if (options_.time_seconds > 0) find_columns(units.size(), pool, render);
    result_ =
        run_units(units, {options_, timer_, options_.time_seconds, "columns"}, estimate_.sums, pool, render);
    costs_ = costs_of(pool);
  }
  Estimate finish();

 private:
  // Under --time: as many columns as leave every slice its turn, by what the first slices take with the
  // fewest. They are rendered again with the others.
  template <typename Workspace, typename Render>
  void find_columns(std::size_t slices, WorkspacePool<Workspace>& pool, Render&& render) {
    lights_.set_columns(0);
    const auto measure = [&]() -> std::size_t {
      const std::vector<std::uint32_t> order = coarse_to_fine(slices);
      const std::size_t tried = std::min(slices, static_cast<std::size_t>(current_threads()));
      parallel_for(tried, 1, [&](std::size_t begin, std::size_t end) {
        typename WorkspacePool<Workspace>::Lease workspace(pool);
        for (std::size_t k = begin; k < end; ++k) render(order[k], *workspace);
      });
      const SliceCosts trial = costs_of(pool);
      pool.for_each([](Workspace& w) { w.costs = {}; });
      return columns_that_fit(slices, tried, trial);
    };
    const auto most = static_cast<std::int64_t>(lights_.most_columns());
    lights_.set_columns(timed_choice(options_, "slice_columns", most, measure));
  }
  std::size_t columns_that_fit(std::size_t slices, std::size_t tried, const SliceCosts& trial) const;
  template <typename Workspace>
  static SliceCosts costs_of(const WorkspacePool<Workspace>& pool) {
    SliceCosts all;
    pool.for_each([&](const Workspace& w) {
      all.seconds_clustering += w.costs.seconds_clustering;
      all.seconds_columns += w.costs.seconds_columns;
      all.entries += w.costs.entries;
      all.most_columns = std::max(all.most_columns, w.costs.most_columns);
    });
    return all;
  }

  Timer timer_;
  const matrix::LightingMatrix& matrix_;
  const RunOptions& options_;
  Estimate estimate_;
  SliceLights lights_;
  UnitResult result_;
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
