#include "methods/slice_cuts/slice_cuts.h"

#include "methods/slice_cuts/slice_run.h"

namespace lumirank::methods {

namespace {

// One slice with all of its visibilities traced. Work space of one thread.
class TracedSlice {
 public:
  TracedSlice(const LightTree& tree, const matrix::LightingMatrix& matrix) : slice_(tree, matrix) {}

  void run(const SliceCutSettings& settings, std::span<const matrix::Index> slice, std::uint64_t key,
           std::span<Rgb> sums) {
    StepTimer timer;
    slice_.choose(settings, slice, key);
    tally_.add_choice(timer.step(), slice_.cut());
    const std::size_t rows = slice_.entries().rows().size();
    visibility_.resize(rows * slice_.columns().size());
    for (std::size_t c = 0; c < slice_.columns().size(); ++c)
      slice_.entries().trace(slice_.columns()[c].column.column,
                             std::span(visibility_).subspan(c * rows, rows));
    tally_.seconds_visibility += timer.step();
    slice_.gather(visibility_, sums);
    tally_.seconds_gather += timer.step();
    tally_.add(slice_);
  }
  const SliceTally& tally() const { return tally_; }

 private:
  SliceColumns slice_;
  std::vector<float> visibility_;
  SliceTally tally_;
};

class SliceCuts final : public Method {
 public:
  explicit SliceCuts(const SliceCutSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    SliceRun run(matrix, options, settings_.slice_rows);
    SliceCutSettings settings = settings_;
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
      SliceCutSettings s = settings_;
      set_cut_level(level.cut, s);
      return s;
    });
    if (!choice) return;
    set_cut_level(choice->level.cut, settings);
    write_cut_level(settings, run.trace());
  }

  SliceCutSettings settings_;
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
      slice_cut_fields());
}

}  // namespace lumirank::methods
