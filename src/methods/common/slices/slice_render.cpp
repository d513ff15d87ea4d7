#include "methods/common/slices/slice_render.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "base/random.h"
#include "matrix/entry_reader.h"

namespace lumirank::methods {

namespace {

struct SliceRenderWorkspace {
  explicit SliceRenderWorkspace(const matrix::LightingMatrix& matrix) : reader(matrix.reader()) {}
  std::unique_ptr<matrix::EntryReader> reader;
  SliceLights::Workspace lights;
  SliceCosts costs;
  PixelDeal deal;
  std::vector<Rgb> entries;

  void add(std::span<const matrix::Index> rows, std::span<Rgb> sums) {
    entries.resize(rows.size());
    reader->set_rows(rows);
    for (const matrix::Index i : rows) sums[i] = Rgb(0);
    for (const matrix::ScaledColumn& c : lights.chosen) {
      reader->column(c.column, entries);
      for (std::size_t a = 0; a < rows.size(); ++a) sums[rows[a]] += lights.added(c, entries[a]);
    }
  }
};

// One where all columns are summed; and fewer where time allows fewer columns than were asked for.
std::size_t fitting_drawings(std::size_t drawings, std::size_t columns, std::size_t asked, std::size_t all) {
  if (columns >= all) return 1;
  return std::clamp<std::size_t>(drawings * columns / std::max<std::size_t>(asked, 1), 1, drawings);
}

}  // namespace

Estimate render_slices(const matrix::LightingMatrix& matrix, const RunOptions& options,
                       const SliceRenderSettings& settings) {
  WorkspacePool<SliceRenderWorkspace> pool([&] { return std::make_unique<SliceRenderWorkspace>(matrix); });
  const std::size_t most = drawings_of(settings.drawings, options);
  return run_slices(
      matrix, options, settings, pool,
      [&](const SliceLights& lights, std::size_t s, SliceRenderWorkspace& w, std::span<Rgb> sums) {
        const auto rows = lights.slices().slice(s);
        const std::size_t drawings =
            fitting_drawings(most, lights.columns(), settings.columns, matrix.columns());
        w.deal.deal(matrix.row_features(), rows, drawings, hash_ids(options.seed, Stage::method, 3, s));
        for (std::size_t d = 0; d < drawings; ++d) {
          if (w.deal.part(d).empty()) continue;
          if (d > 0) lights.redraw(s, d, w.lights);
          w.add(w.deal.part(d), sums);
        }
      });
}

}  // namespace lumirank::methods
