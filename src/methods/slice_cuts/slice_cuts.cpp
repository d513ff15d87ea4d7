#include "methods/slice_cuts/slice_cuts.h"

#include "methods/common/slices/slice_fields.h"
#include "methods/slice_cuts/slice_drawings.h"
#include "methods/slice_cuts/slice_run.h"

namespace lumirank::methods {

namespace {

struct SliceCutsSettings : SliceCutSettings {
  SliceCutsSettings() { drawings = 0; }  // see drawings_of()
};

const Fields<SliceCutsSettings>& fields() {
  static const Fields<SliceCutsSettings> all = [] {
    auto fields = inherited_fields<SliceCutsSettings>(slice_cut_fields());
    fields.push_back(drawings_field<SliceCutsSettings>(&SliceCutsSettings::drawings));
    return fields;
  }();
  return all;
}

// One slice with all of its visibilities traced. Work space of one thread.
class TracedSlice {
 public:
  TracedSlice(const LightTree& tree, const matrix::LightingMatrix& matrix)
      : slice_(tree, matrix), drawings_(matrix.row_features()) {}

  void run(const SliceCutSettings& settings, std::span<const matrix::Index> slice, std::uint64_t key,
           std::span<Rgb> sums) {
    drawings_.run(settings, slice, key, slice_, tally_, [&] {
      StepTimer timer;
      const std::size_t rows = slice_.entries().rows().size();
      visibility_.resize(rows * slice_.columns().size());
      for (std::size_t c = 0; c < slice_.columns().size(); ++c)
        slice_.entries().trace(slice_.columns()[c].column.column,
                               std::span(visibility_).subspan(c * rows, rows));
      tally_.seconds_visibility += timer.step();
      slice_.gather(visibility_, sums);
      tally_.seconds_gather += timer.step();
      tally_.add(slice_);
    });
  }
  const SliceTally& tally() const { return tally_; }

 private:
  SliceColumns slice_;
  SliceDrawings drawings_;
  std::vector<float> visibility_;
  SliceTally tally_;
};

class SliceCuts final : public Method {
 public:
  explicit SliceCuts(const SliceCutsSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    SliceRun run(matrix, options, settings_);
    SliceCutSettings settings = settings_;
    settings.drawings = drawings_of(settings.drawings, options);
    if (options.target_error > 0) search(matrix, run, settings);
    WorkspacePool<TracedSlice> pool([&] { return std::make_unique<TracedSlice>(run.tree(), matrix); });
    run.run(settings, true, pool);
    SliceTally tally;
    pool.for_each([&](const TracedSlice& slice) { tally += slice.tally(); });
    write_tally(tally, "visibility", run.trace());
    return run.finish(tally);
  }

 private:
  void search(const matrix::LightingMatrix& matrix, SliceRun& run, SliceCutSettings& settings) const {
    WorkspacePool<TracedSlice> pool([&] { return std::make_unique<TracedSlice>(run.tree(), matrix); });
    const auto choice = run.search(pool, false, [&](const SliceLevel& level) {
      SliceCutSettings s = settings;
      set_cut_level(level.cut, s);
      return s;
    });
    if (!choice) return;
    set_cut_level(choice->level.cut, settings);
    write_cut_level(settings, run.trace());
  }

  SliceCutsSettings settings_;
};

}  // namespace

// What its cuts sample of visibilities says which clusters to split; what it sums it traces, so visibilities
// may lie between 0 and 1.
MethodInfo slice_cuts_info() {
  return method_info<SliceCuts>(
      {"slice-cuts",
       "Cuts the light tree for every slice of receivers, and traces a visibility per pixel's surface.",
       "The light clusters of Huo et al. 2015 (section 4), without their recovery",
       "",
       {.needs = {matrix::Ability::bounds}, .segments = matrix::MethodContract::Segments::light_pieces}},
      fields());
}

}  // namespace lumirank::methods
