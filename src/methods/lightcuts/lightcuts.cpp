// Lightcuts (Walter et al. 2005): for every receiver a cut of its own through the light tree, refined until
// no node's bound exceeds 2 % of the receiver's total; and between such cuts, reconstruction cuts.
//
// Our deviations: cuts are refined in rounds of a few nodes and beside those of neighbors (cut.h). Bounds
// and totals are compared by luminance. Receivers between cuts are reconstructed in blocks of 4×4 pixels with
// as many further cuts as their surfaces need; materials are alike where they answer some lights alike
// (probe_responses.h); an interpolated node is shaded anew by its representative's unoccluded entry, where
// the paper keeps a directional light for the purpose (reconstruction.h).
#include "methods/lightcuts/lightcuts.h"

#include <algorithm>
#include <numeric>

#include "methods/common/exact_rows.h"
#include "methods/common/light_tree/cut_costs.h"
#include "methods/common/light_tree/light_tree.h"
#include "methods/common/turns.h"
#include "methods/lightcuts/block_painter.h"
#include "methods/lightcuts/lightcuts_method.h"
#include "methods/parameters.h"

namespace lumirank::methods {

namespace {

using matrix::Index;

const Fields<LightcutsSettings> kLightcutsFields{
    number_field<LightcutsSettings>({"error-bound", "",
                                     "A node is refined while its bound exceeds this share of the "
                                     "receiver's total. 0 with no limit of nodes is brute force."},
                                    &LightcutsSettings::error_bound, 0, 1),
    count_field<LightcutsSettings>({"max-nodes", "nodes", "Of a receiver's cut; time is in proportion."},
                                   &LightcutsSettings::max_nodes, 1, kMaxColumns),
    choice_field<LightcutsSettings>(
        {"reconstruction", "",
         "on: few receivers have a cut of their own; what cuts in the neighborhood agree in is "
         "interpolated between them. off: every receiver has its own; many times slower."},
        &LightcutsSettings::reconstruction, {"on", "off"}),
    number_field<LightcutsSettings>({"interpolation-tolerance", "",
                                     "Cuts agree in a node when they differ in it by less than this share of "
                                     "the receiver's total."},
                                    &LightcutsSettings::interpolation_tolerance, 0, 1),
    number_field<LightcutsSettings>({"similarity", "",
                                     "Receivers learn from each other where their responses to 32 lights, "
                                     "nothing in between, make an angle of at least this cosine. Nearer to 1 "
                                     "gives more receivers cuts of their own."},
                                    &LightcutsSettings::similarity, 0, 1)};

// Of a first guess: cuts are found, not set.
constexpr double kEntriesPerRow = 300;

struct LightcutsWorkspace {
  LightcutsWorkspace(const matrix::LightingMatrix& matrix, const LightTree& tree,
                     const LightcutsSettings& settings)
      : reader(matrix.reader()),
        cuts(matrix, tree, {settings.error_bound, settings.max_nodes}),
        painter(matrix, tree, settings.interpolation_tolerance, settings.similarity) {}
  std::unique_ptr<matrix::EntryReader> reader;
  ReceiverCuts cuts;
  BlockPainter painter;
};
using LightcutsPool = WorkspacePool<LightcutsWorkspace>;

// Stretches of rows, which are kept in an order in which neighbors lie close.
RowGroups stretches(std::size_t rows) {
  std::vector<Index> all(rows);
  std::iota(all.begin(), all.end(), 0u);
  std::vector<std::uint32_t> first;
  for (std::size_t i = 0; i < rows; i += ReceiverCuts::kTogether)
    first.push_back(static_cast<std::uint32_t>(i));
  first.push_back(static_cast<std::uint32_t>(rows));
  return {std::move(all), std::move(first)};
}

void write_costs(const LightcutsPool& pool, const matrix::LightingMatrix& matrix, Trace& trace) {
  CutCosts costs;
  double interpolated = 0;
  auto& numbers = trace.numbers;
  pool.for_each([&](const LightcutsWorkspace& w) {
    costs.add({static_cast<double>(w.cuts.cuts_made()), static_cast<double>(w.cuts.nodes()),
               static_cast<double>(w.cuts.max_nodes()), static_cast<double>(w.cuts.bounds_computed()),
               static_cast<double>(w.cuts.rounds().entries() + w.painter.shaded())});
    interpolated += static_cast<double>(w.painter.interpolated());
    numbers["cpu_seconds.bounds"] += w.cuts.rounds().seconds_cuts();
    numbers["cpu_seconds.entries"] += w.cuts.rounds().seconds_entries();
    numbers["cpu_seconds.reconstruction"] += w.painter.seconds();
  });
  costs.write(matrix, "cut_nodes", numbers);
  numbers["interpolated"] = interpolated / std::max(1.0, static_cast<double>(matrix.rows()));
}

// A coarser or a finer cut is no other draw of the same, so turns replace each other.
RowGroupResult run_cuts(const LightcutsSettings& settings, const matrix::LightingMatrix& matrix,
                        const RowGroupControl& control, Turns& turns, LightcutsPool& pool,
                        std::span<Rgb> all_sums) {
  const TurnMethod method{.averaged = false, .entries_per_row = kEntriesPerRow};
  const auto limits = [&](const Turn& turn) {
    return CutLimits{std::min(1.0, settings.error_bound / turn.quality), turn.scaled(settings.max_nodes)};
  };
  const bool image = matrix.rows() > 0 && !matrix.row_features().pixel.empty();
  if (settings.reconstruction == Reconstruction::on && image) {
    const ImageBlocks blocks(matrix);
    return run_in_turns(turns, blocks.row_groups(), control, method, all_sums, pool,
                        [&](std::size_t group, LightcutsWorkspace& w, const Turn& turn, std::span<Rgb> sums) {
                          w.cuts.limit(limits(turn));
                          w.painter.paint(blocks, group, w.cuts, *w.reader, sums);
                        });
  }
  const RowGroups row_groups = stretches(matrix.rows());
  return run_in_turns(turns, row_groups, control, method, all_sums, pool,
                      [&](std::size_t group, LightcutsWorkspace& w, const Turn& turn, std::span<Rgb> sums) {
                        w.cuts.limit(limits(turn));
                        w.cuts.cut(row_groups[group], *w.reader,
                                   [&](std::size_t, const Cut& cut) { sums[cut.row()] = cut.total(); });
                      });
}

}  // namespace

Estimate Lightcuts::run(const matrix::LightingMatrix& matrix, const RunOptions& options) const {
  const RunClock timer(options);
  Estimate estimate;
  estimate.sums.assign(matrix.rows(), Rgb(0));
  Turns turns(matrix, options, timer, estimate.sums);
  RowsForError rows(matrix, options, timer);
  const double before_tree = timer.seconds();
  const LightTree tree(matrix, options.seed);
  estimate.trace.numbers["seconds.tree"] = timer.seconds() - before_tree;
  {
    LightcutsPool pool([&] { return std::make_unique<LightcutsWorkspace>(matrix, tree, settings_); });
    const RowGroupControl control{options, timer, 0, "columns"};
    const RowGroupResult pass = run_cuts(settings_, matrix, control, turns, pool, estimate.sums);
    turns.write(estimate.trace);
    note_stop(pass, estimate);
    estimate.trace.numbers["seconds.columns"] = pass.seconds;
    write_costs(pool, matrix, estimate.trace);
  }
  if (!estimate.interrupted) rows.state(estimate.sums, estimate.trace.numbers.at("columns"), estimate.trace);
  if (options.on_estimate) options.on_estimate(estimate.sums);
  return estimate;
}

MethodInfo lightcuts_info() {
  return method_info<Lightcuts>(
      {"lightcuts",
       "For each receiver a cut through a tree of lights, refined by error bounds.",
       "Walter, Fernandez, Arbree, Bala, Donikian, Greenberg: Lightcuts: a scalable approach to "
       "illumination, SIGGRAPH 2005",
       "error-bound or max-nodes",
       {.needs = {matrix::Ability::bounds}, .segments = matrix::MethodContract::Segments::light_pieces}},
      kLightcutsFields);
}

}  // namespace lumirank::methods
