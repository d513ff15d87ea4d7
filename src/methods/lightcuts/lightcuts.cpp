// Lightcuts (Walter et al. 2005): for every receiver a cut of its own through the light tree, refined until
// no node's bound exceeds 2 % of the receiver's total.
#include "methods/lightcuts/lightcuts.h"

#include <algorithm>
#include <numeric>

#include "methods/known_rows.h"
#include "methods/light_tree/light_tree.h"
#include "methods/lightcuts/cut.h"
#include "methods/parameters.h"
#include "methods/unit_pass.h"

namespace lumirank::methods {

namespace {

using matrix::Index;

struct LightcutsSettings {
  double error_bound = 0.02;
  std::size_t most_nodes = 1000;
};

const Fields<LightcutsSettings> kFields{
    number_field<LightcutsSettings>({"error-bound", "",
                                     "A node is refined while its bound exceeds this share of the "
                                     "receiver's total. 0 with no limit of nodes is brute force."},
                                    &LightcutsSettings::error_bound, 0, 1),
    count_field<LightcutsSettings>({"most-nodes", "nodes", "Of a receiver's cut; time is in proportion."},
                                   &LightcutsSettings::most_nodes, 1)};

// Receivers whose cuts are refined side by side: neighbours, which ask for like entries.
constexpr std::size_t kTogether = 4;

struct Workspace {
  std::unique_ptr<matrix::EntryReader> reader;
  std::vector<std::unique_ptr<matrix::RowBounds>> bounds;  // one for each cut at hand
  std::vector<Cut> cuts;
  CutRounds rounds;
  std::uint64_t nodes = 0, bounds_computed = 0, most_nodes = 0;
};

class Lightcuts final : public Method {
 public:
  explicit Lightcuts(const LightcutsSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    const Timer timer;
    const LightTree tree(matrix, options.seed);
    const double seconds_tree = timer.seconds();
    Estimate estimate;
    estimate.sums.assign(matrix.rows(), Rgb(0));
    auto& numbers = estimate.trace.numbers;
    double entries = 0;
    {
      WorkspacePool<Workspace> pool([&] {
        auto w = std::make_unique<Workspace>();
        w->reader = matrix.reader();
        for (std::size_t k = 0; k < kTogether; ++k) {
          w->bounds.push_back(matrix.row_bounds());
          w->cuts.emplace_back(tree, CutLimits{settings_.error_bound, settings_.most_nodes});
        }
        return w;
      });
      const UnitRows units = stretches(matrix.rows());
      const UnitResult pass =
          run_units(units, {options, timer, options.time_seconds, "columns"}, estimate.sums, pool,
                    [&](std::size_t unit, Workspace& w) { cut_all(units[unit], w, estimate.sums); });
      note_stop(pass, estimate);
      numbers["seconds.columns"] = pass.seconds;
      write_costs(pool, matrix, numbers);
      entries = numbers["columns"];
    }
    numbers["seconds.tree"] = seconds_tree;
    if (!estimate.interrupted) look_at_rows(matrix, options, estimate.sums, entries, estimate.trace);
    if (options.on_estimate) options.on_estimate(estimate.sums);
    return estimate;
  }

 private:
  static UnitRows stretches(std::size_t rows) {
    std::vector<Index> all(rows);
    std::iota(all.begin(), all.end(), 0u);
    std::vector<std::uint32_t> first;
    for (std::size_t i = 0; i < rows; i += kTogether) first.push_back(static_cast<std::uint32_t>(i));
    first.push_back(static_cast<std::uint32_t>(rows));
    return {std::move(all), std::move(first)};
  }

  static void cut_all(std::span<const Index> rows, Workspace& w, std::span<Rgb> sums) {
    const std::span<Cut> cuts = std::span(w.cuts).first(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
      w.bounds[k]->set_rows(rows.subspan(k, 1));
      cuts[k].begin(rows[k], *w.bounds[k]);
    }
    w.rounds.finish(cuts, *w.reader);
    for (const Cut& cut : cuts) {
      sums[cut.row()] = cut.total();
      w.nodes += cut.size(), w.bounds_computed += cut.bounds_computed();
      w.most_nodes = std::max<std::uint64_t>(w.most_nodes, cut.size());
    }
  }

  static void write_costs(const WorkspacePool<Workspace>& pool, const matrix::LightingMatrix& matrix,
                          std::map<std::string, double>& numbers) {
    const auto rows = std::max(1.0, static_cast<double>(matrix.rows()));
    double nodes = 0, most = 0, bounds = 0, entries = 0;
    pool.for_each([&](const Workspace& w) {
      nodes += static_cast<double>(w.nodes), most = std::max(most, static_cast<double>(w.most_nodes));
      bounds += static_cast<double>(w.bounds_computed), entries += static_cast<double>(w.rounds.entries());
      numbers["cpu_seconds.cuts"] += w.rounds.seconds_cuts();
      numbers["cpu_seconds.entries"] += w.rounds.seconds_entries();
    });
    numbers["rows"] = 0;
    numbers["columns"] = nodes / rows;
    numbers["columns_max"] = most;
    numbers["bounds"] = bounds / rows;
    const auto columns = static_cast<double>(matrix.columns());
    numbers["sampling_rate"] = columns > 0 ? entries / rows / columns : 1.0;
  }

  LightcutsSettings settings_;
};

}  // namespace

MethodInfo lightcuts_info() {
  const std::string name = "lightcuts";
  return {name,
          "For each receiver a cut through a tree of lights, refined by error bounds.",
          "Walter, Fernandez, Arbree, Bala, Donikian, Greenberg: Lightcuts: a scalable approach to "
          "illumination, SIGGRAPH 2005",
          parameters_of(kFields),
          [=](const SettingsMap& settings) -> std::unique_ptr<Method> {
            return std::make_unique<Lightcuts>(read_settings(name, kFields, settings));
          },
          [](const SettingsMap&) -> std::size_t { return 0; }};
}

}  // namespace lumirank::methods
