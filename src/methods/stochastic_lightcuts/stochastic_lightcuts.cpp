// Stochastic lightcuts: for every receiver a cut of its own through the light tree, and from each node of the
// cut one column, drawn on a walk down the tree by what bounds say of either child (Yuksel, "Stochastic
// Lightcuts", HPG 2019; "Stochastic Lightcuts for Sampling Many Lights", TVCG 2020). Light cuts show the same
// representatives everywhere, an error of structure; here it is noise.
//
// Unbiased: cuts depend on bounds alone. With `error-bound` their size depends on a total that is estimated
// by columns of their own, `pilot` of them, which do not enter the sum. Deviation: Yuksel takes the total
// from the very columns that are summed, which saves them and is biased.
#include "methods/stochastic_lightcuts/stochastic_lightcuts.h"

#include <algorithm>
#include <numeric>

#include "base/random.h"
#include "matrix/entry_reader.h"
#include "methods/common/exact_rows.h"
#include "methods/common/turns.h"
#include "methods/parameters.h"
#include "methods/stochastic_lightcuts/light_walk.h"

namespace lumirank::methods {

namespace {

using matrix::Index;

struct StochasticSettings {
  std::size_t nodes = 100;
  double error_bound = 0;
  std::size_t pilot = 8;
};

const Fields<StochasticSettings> kStochasticFields{
    count_field<StochasticSettings>(
        {"nodes", "nodes", "Of a receiver's cut at most, and columns drawn; time is in proportion."},
        &StochasticSettings::nodes, 1, kMaxColumns),
    number_field<StochasticSettings>(
        {"error-bound", "",
         "A node is split while its bound exceeds this share of the receiver's total. 0: until the cut is "
         "full."},
        &StochasticSettings::error_bound, 0, 1),
    count_field<StochasticSettings>(
        {"pilot", "columns", "By which the total is estimated beforehand, where an error bound needs it."},
        &StochasticSettings::pilot, 1, kMaxColumns)};

// Receivers whose entries are asked for together: neighbors.
constexpr std::size_t kRowsTogether = 16;

struct WalkWorkspace {
  WalkWorkspace(const matrix::LightingMatrix& matrix, const LightTree& tree)
      : reader(matrix.reader()), bounds(matrix.row_bounds()), row_ids(matrix.row_features().id), walk(tree) {}
  std::unique_ptr<matrix::EntryReader> reader;
  std::unique_ptr<matrix::RowBounds> bounds;
  std::span<const std::uint64_t> row_ids;
  LightWalk walk;
  std::vector<DrawnColumn> drawn;
  std::vector<std::size_t> ends;  // of each row's columns in `drawn`
  std::vector<Index> rows, columns;
  std::vector<Rgb> entries;
  std::vector<float> limits;
  std::uint64_t nodes = 0, max_nodes = 0, evaluated = 0;
  double seconds_cuts = 0, seconds_entries = 0;
};

class StochasticLightcuts final : public Method {
 public:
  explicit StochasticLightcuts(const StochasticSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    const RunClock timer(options);
    Estimate estimate;
    estimate.sums.assign(matrix.rows(), Rgb(0));
    Turns turns(matrix, options, timer, estimate.sums);
    RowsForError rows(matrix, options, timer);
    const double before_tree = timer.seconds();
    const LightTree tree(matrix, options.seed);
    const double seconds_tree = timer.seconds() - before_tree;
    auto& numbers = estimate.trace.numbers;
    {
      WorkspacePool<WalkWorkspace> pool([&] { return std::make_unique<WalkWorkspace>(matrix, tree); });
      const RowGroups row_groups = stretches(matrix.rows());
      TurnMethod method{.entries_per_row = static_cast<double>(settings_.nodes)};
      if (settings_.error_bound == 0)
        method.exact_from = static_cast<double>(tree.leaves()) / static_cast<double>(settings_.nodes);
      const RowGroupResult pass =
          run_in_turns(turns, row_groups, {options, timer, 0, "columns"}, method, estimate.sums, pool,
                       [&](std::size_t group, WalkWorkspace& w, const Turn& turn, std::span<Rgb> sums) {
                         sum_rows(row_groups[group], options.seed, turn, w, sums);
                       });
      turns.write(estimate.trace);
      note_stop(pass, estimate);
      numbers["seconds.columns"] = pass.seconds;
      write_costs(pool, matrix, numbers);
    }
    numbers["seconds.tree"] = seconds_tree;
    if (!estimate.interrupted) rows.state(estimate.sums, numbers["columns"], estimate.trace);
    if (options.on_estimate) options.on_estimate(estimate.sums);
    return estimate;
  }

 private:
  static RowGroups stretches(std::size_t rows) {
    std::vector<Index> all(rows);
    std::iota(all.begin(), all.end(), 0u);
    std::vector<std::uint32_t> first;
    for (std::size_t i = 0; i < rows; i += kRowsTogether) first.push_back(static_cast<std::uint32_t>(i));
    first.push_back(static_cast<std::uint32_t>(rows));
    return {std::move(all), std::move(first)};
  }

  void sum_rows(std::span<const Index> rows, std::uint64_t seed, const Turn& turn, WalkWorkspace& w,
                std::span<Rgb> sums) const {
    const std::uint64_t stream = 2 * turn.number;
    w.limits.assign(rows.size(), 0.0f);
    if (settings_.error_bound > 0) {
      draw(rows, seed, stream + 1, settings_.pilot, w);
      std::size_t k = 0;
      for (std::size_t r = 0; r < rows.size(); ++r)
        w.limits[r] = static_cast<float>(settings_.error_bound / turn.quality) *
                      std::max(0.0f, luminance(take_sum(w, w.ends[r], k)));
    }
    draw(rows, seed, stream, turn.scaled(settings_.nodes), w);
    std::size_t k = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) sums[rows[r]] = take_sum(w, w.ends[r], k);
  }

  // Cuts of `nodes` for all rows, columns for them and their entries.
  void draw(std::span<const Index> rows, std::uint64_t seed, std::uint64_t stream, std::size_t nodes,
            WalkWorkspace& w) const {
    const Timer timer;
    w.drawn.clear(), w.ends.clear(), w.rows.clear(), w.columns.clear();
    for (std::size_t r = 0; r < rows.size(); ++r) {
      Rng rng(seed, Stage::method, matrix::id_of(w.row_ids, rows[r]), stream);
      w.bounds->set_rows(rows.subspan(r, 1));
      w.walk.begin(*w.bounds);
      w.walk.refine(nodes, w.limits[r]);
      w.walk.draw([&] { return unit_double(rng.next_bits()); }, w.drawn);
      w.ends.push_back(w.drawn.size());
      w.rows.resize(w.drawn.size(), rows[r]);
      if (stream % 2 == 0) {
        w.nodes += w.walk.size();
        w.max_nodes = std::max<std::uint64_t>(w.max_nodes, w.walk.size());
      }
    }
    for (const DrawnColumn& d : w.drawn) w.columns.push_back(d.column);
    w.entries.resize(w.drawn.size());
    const double cuts = timer.seconds();
    w.reader->entries(w.rows, w.columns, w.entries);
    w.evaluated += w.drawn.size();
    w.seconds_cuts += cuts, w.seconds_entries += timer.seconds() - cuts;
  }

  // Of the entries from k on, which goes to `end`.
  static Rgb take_sum(const WalkWorkspace& w, std::size_t end, std::size_t& k) {
    double sum[3] = {0, 0, 0};
    for (; k < end; ++k)
      for (int c = 0; c < 3; ++c)
        sum[c] += static_cast<double>(w.entries[k][c]) / static_cast<double>(w.drawn[k].probability);
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
  }

  static void write_costs(const WorkspacePool<WalkWorkspace>& pool, const matrix::LightingMatrix& matrix,
                          std::map<std::string, double>& numbers) {
    const auto rows = std::max(1.0, static_cast<double>(matrix.rows()));
    double nodes = 0, max_nodes = 0, bounds = 0, entries = 0;
    pool.for_each([&](const WalkWorkspace& w) {
      nodes += static_cast<double>(w.nodes),
          max_nodes = std::max(max_nodes, static_cast<double>(w.max_nodes));
      bounds += static_cast<double>(w.walk.bounds_computed()), entries += static_cast<double>(w.evaluated);
      numbers["cpu_seconds.cuts"] += w.seconds_cuts;
      numbers["cpu_seconds.entries"] += w.seconds_entries;
    });
    numbers["rows"] = 0;
    numbers["columns"] = nodes / rows;
    numbers["columns_max"] = max_nodes;
    numbers["bounds"] = bounds / rows;
    const auto columns = static_cast<double>(matrix.columns());
    numbers["sampling_rate"] = columns > 0 ? entries / rows / columns : 1.0;
  }

  StochasticSettings settings_;
};

}  // namespace

MethodInfo stochastic_lightcuts_info() {
  return method_info<StochasticLightcuts>(
      {"stochastic-lightcuts",
       "For each receiver a cut through a tree of lights, and a light drawn from each of its nodes.",
       "Yuksel: Stochastic Lightcuts, HPG 2019; Stochastic Lightcuts for Sampling Many Lights, IEEE TVCG "
       "2020",
       "nodes or error-bound",
       {.needs = {matrix::Ability::bounds}, .segments = matrix::MethodContract::Segments::light_pieces}},
      kStochasticFields);
}

}  // namespace lumirank::methods
