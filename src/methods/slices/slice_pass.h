// What methods with columns of their own for every slice share: rows, clusters, the pass over slices, and
// what the trace says of them.
#pragma once

#include <utility>

#include "base/timer.h"
#include "methods/slices/slice_lights.h"
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
    result_ = run_units(units, {options_, timer_, options_.time_seconds, "columns"}, estimate_.sums, pool,
                        [&](std::size_t s, Workspace& w) {
                          const Timer timer;
                          lights_.choose(s, w.lights);
                          const double chosen = timer.seconds();
                          body(lights_, s, w, std::span<Rgb>(estimate_.sums));
                          const std::size_t columns = w.lights.chosen.size();
                          w.costs.entries += columns * lights_.slices().slice(s).size();
                          w.costs.most_columns = std::max<std::uint64_t>(w.costs.most_columns, columns);
                          w.costs.seconds_clustering += chosen;
                          w.costs.seconds_columns += timer.seconds() - chosen;
                        });
    pool.for_each([&](const Workspace& w) {
      costs_.seconds_clustering += w.costs.seconds_clustering;
      costs_.seconds_columns += w.costs.seconds_columns;
      costs_.entries += w.costs.entries;
      costs_.most_columns = std::max(costs_.most_columns, w.costs.most_columns);
    });
  }
  Estimate finish();

 private:
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
