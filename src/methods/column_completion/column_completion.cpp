#include "methods/column_completion/column_completion.h"

#include <algorithm>

#include "base/random.h"
#include "matrix/entry_reader.h"
#include "methods/column_completion/completion_slices.h"
#include "methods/column_completion/slice_estimate.h"
#include "methods/common/exact_rows.h"
#include "methods/common/turns.h"
#include "methods/parameters.h"

namespace lumirank::methods {

namespace {

// graph: as the scene's graph of light segments was halved.
enum class ColumnTreeKind { places, graph };

struct ColumnCompletionSettings : CompletionSpaceSettings {
  std::size_t slice_rows = 2048;
  RowPartition partition = RowPartition::places;
  ColumnTreeKind tree = ColumnTreeKind::places;
};

const Fields<ColumnCompletionSettings>& column_completion_fields() {
  using S = ColumnCompletionSettings;
  static const Fields<S> fields{
      number_field<S>({"rho", "of a slice's rows",
                       "In which a column is sampled before it is completed (the paper: 0.1; 0.2 where "
                       "scattering is strongly forward). 0: as many as each slice is found to need."},
                      &S::rho, 0, 1),
      number_field<S>({"sigma", "of a slice's light",
                       "What completion may miss of what a column stands for; columns that miss more are "
                       "sampled wholly."},
                      &S::sigma, 0, 1),
      number_field<S>({"beta", "of a slice's light",
                       "A node of columns that errs by more, as those drawn tell, is divided."},
                      &S::beta, 0, 1),
      count_field<S>({"samples", "columns", "Drawn of each node."}, &S::samples, 1, 1000),
      count_field<S>({"asked", "rows",
                      "Of a slice, that tell first what the tree's coarse nodes bring, so that more of the "
                      "columns drawn matter (the paper: 0)."},
                     &S::asked, 0, 1000),
      count_field<S>({"slice-rows", "rows", "Of a slice by place, at most."}, &S::slice_rows, 1, kMaxRows),
      experiment(choice_field<S>({"partition", "",
                                  "graph: slices of eye segments as the scene's graph has them, of "
                                  "receivers, and without media of all rows, by place, as in the paper; "
                                  "places: all by place and direction; stretches: by number, along the "
                                  "film; k-means: as many clusters of segments as the graph has."},
                                 &S::partition, {"graph", "places", "stretches", "k-means"})),
      experiment(choice_field<S>({"tree", "",
                                  "Of light rays: places: whole rays by place and direction; graph: cut, "
                                  "and divided by halves of the scene's graph, as in the paper."},
                                 &S::tree, {"places", "graph"}))};
  return fields;
}

struct ColumnCompletionWorkspace {
  ColumnCompletionWorkspace(const matrix::LightingMatrix& matrix, const ColumnTree& tree,
                            const CompletionSpaceSettings& settings)
      : reader(matrix.reader()), estimate(tree, matrix.row_features(), settings) {}
  std::unique_ptr<matrix::EntryReader> reader;
  SliceEstimate estimate;
};

class ColumnCompletion final : public Method {
 public:
  explicit ColumnCompletion(const ColumnCompletionSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    const RunClock timer(options);
    Estimate estimate;
    estimate.sums.assign(matrix.rows(), Rgb(0));
    Turns turns(matrix, options, timer, estimate.sums);
    RowsForError rows(matrix, options, timer);
    const double before_tree = timer.seconds();
    const ColumnTree tree(matrix, settings_.samples);
    const Slices slices =
        completion_slices(matrix.row_features(), matrix.rows(), settings_.slice_rows, settings_.partition);
    auto& numbers = estimate.trace.numbers;
    numbers["seconds.tree"] = timer.seconds() - before_tree;
    numbers["slices"] = static_cast<double>(slices.count());
    WorkspacePool<ColumnCompletionWorkspace> pool(
        [&] { return std::make_unique<ColumnCompletionWorkspace>(matrix, tree, settings_); });
    const TurnMethod method{.entries_per_row = 0.05 * static_cast<double>(matrix.columns())};
    const RowGroupResult pass = run_in_turns(
        turns, RowGroups(slices.rows, slices.first), {options, timer, 0, "columns"}, method, estimate.sums,
        pool, [&](std::size_t s, ColumnCompletionWorkspace& w, const Turn& turn, std::span<Rgb> sums) {
          w.estimate.run(slices.slice(s), *w.reader, turn.quality,
                         hash_ids(options.seed, Stage::method, turn.number), sums);
        });
    turns.write(estimate.trace);
    note_stop(pass, estimate);
    numbers["seconds.columns"] = pass.seconds;
    write_counts(pool, matrix, numbers);
    if (!estimate.interrupted) rows.state(estimate.sums, numbers["columns"], estimate.trace);
    if (options.on_estimate) options.on_estimate(estimate.sums);
    return estimate;
  }

 private:
  static void write_counts(const WorkspacePool<ColumnCompletionWorkspace>& pool,
                           const matrix::LightingMatrix& matrix, std::map<std::string, double>& numbers) {
    SliceEstimate::Counts all;
    pool.for_each([&](const ColumnCompletionWorkspace& w) {
      const auto& c = w.estimate.counts();
      all.slices += c.slices, all.nodes += c.nodes, all.columns += c.columns, all.dense += c.dense;
      all.entries += c.entries, all.rank += c.rank, all.sampled_rows += c.sampled_rows;
      all.max_rank = std::max(all.max_rank, c.max_rank);
      all.max_entries_per_row = std::max(all.max_entries_per_row, c.max_entries_per_row);
    });
    const auto per = [](std::uint64_t what, std::uint64_t of) {
      return of > 0 ? static_cast<double>(what) / static_cast<double>(of) : 0.0;
    };
    const auto rows = static_cast<double>(matrix.rows()), columns = static_cast<double>(matrix.columns());
    numbers["rows"] = 0;
    numbers["columns"] = rows > 0 ? static_cast<double>(all.entries) / rows : 0;
    numbers["columns_max"] = static_cast<double>(all.max_entries_per_row);
    numbers["nodes"] = per(all.nodes, all.slices);
    numbers["completion.columns"] = per(all.columns, all.slices);
    numbers["completion.sampled_wholly"] = per(all.dense, all.columns);
    numbers["completion.rank"] = per(all.rank, all.slices);
    numbers["completion.max_rank"] = static_cast<double>(all.max_rank);
    numbers["completion.rows_sampled"] = per(all.sampled_rows, all.columns - all.dense);
    numbers["sampling_rate"] = rows * columns > 0 ? static_cast<double>(all.entries) / (rows * columns) : 1.0;
  }

  ColumnCompletionSettings settings_;
};

}  // namespace

MethodInfo column_completion_info() {
  using Segments = matrix::MethodContract::Segments;
  MethodInfo info = method_info<ColumnCompletion>(
      {"column-completion",
       "Slices of receivers draw columns from a tree, and know most of them by few of their rows.",
       "Huo, Wang, Hu, Hua, Jin 2016, Adaptive matrix column sampling and completion for rendering "
       "participating media",
       "beta or sigma or rho",
       {.needs = {}, .segments = Segments::smooth_pieces}},
      column_completion_fields());
  info.segments_wanted = [name = info.name](const SettingsMap& settings) {
    const auto read = read_settings(name, column_completion_fields(), settings);
    if (read.tree == ColumnTreeKind::graph) return Segments::groups_and_tree;
    const bool by_graph = read.partition == RowPartition::given || read.partition == RowPartition::k_means;
    return by_graph ? Segments::groups : Segments::smooth_pieces;
  };
  return info;
}

}  // namespace lumirank::methods
