#include "methods/lightslice/lightslice.h"

#include "matrix/entry_reader.h"
#include "methods/common/slices/slice_pass.h"

namespace lumirank::methods {

namespace {

struct LightSliceWorkspace {
  explicit LightSliceWorkspace(const matrix::LightingMatrix& matrix) : reader(matrix.reader()) {}
  std::unique_ptr<matrix::EntryReader> reader;
  SliceLights::Workspace lights;
  SliceCosts costs;
  std::vector<Rgb> entries;
};

class LightSlice final : public Method {
 public:
  explicit LightSlice(const SliceLightSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    WorkspacePool<LightSliceWorkspace> pool([&] { return std::make_unique<LightSliceWorkspace>(matrix); });
    return run_slices(matrix, options, settings_, pool, render);
  }

 private:
  static void render(const SliceLights& lights, std::size_t s, LightSliceWorkspace& w, std::span<Rgb> sums) {
    const auto rows = lights.slices().slice(s);
    w.entries.resize(rows.size());
    w.reader->set_rows(rows);
    for (const matrix::Index i : rows) sums[i] = Rgb(0);
    for (const matrix::ScaledColumn& c : w.lights.chosen) {
      w.reader->column(c.column, w.entries);
      for (std::size_t a = 0; a < rows.size(); ++a) sums[rows[a]] += w.lights.added(c, w.entries[a]);
    }
  }

  SliceLightSettings settings_;
};

}  // namespace

MethodInfo lightslice_info() {
  return method_info<LightSlice>(
      {"lightslice", "Clusters columns for every slice of receivers on their own.",
       "Ou, Pellacini 2011, LightSlice: matrix slice sampling for the many-lights problem", "columns"},
      slice_light_fields());
}

}  // namespace lumirank::methods
