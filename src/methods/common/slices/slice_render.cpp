#include "methods/common/slices/slice_render.h"

#include <memory>
#include <vector>

#include "matrix/entry_reader.h"

namespace lumirank::methods {

namespace {

struct SliceRenderWorkspace {
  explicit SliceRenderWorkspace(const matrix::LightingMatrix& matrix) : reader(matrix.reader()) {}
  std::unique_ptr<matrix::EntryReader> reader;
  SliceLights::Workspace lights;
  SliceCosts costs;
  std::vector<Rgb> entries;
};

}  // namespace

Estimate render_slices(const matrix::LightingMatrix& matrix, const RunOptions& options,
                       const SliceLightSettings& settings) {
  WorkspacePool<SliceRenderWorkspace> pool([&] { return std::make_unique<SliceRenderWorkspace>(matrix); });
  return run_slices(
      matrix, options, settings, pool,
      [](const SliceLights& lights, std::size_t s, SliceRenderWorkspace& w, std::span<Rgb> sums) {
        const auto rows = lights.slices().slice(s);
        w.entries.resize(rows.size());
        w.reader->set_rows(rows);
        for (const matrix::Index i : rows) sums[i] = Rgb(0);
        for (const matrix::ScaledColumn& c : w.lights.chosen) {
          w.reader->column(c.column, w.entries);
          for (std::size_t a = 0; a < rows.size(); ++a) sums[rows[a]] += w.lights.added(c, w.entries[a]);
        }
      });
}

}  // namespace lumirank::methods
