// Multidimensional lightcuts (Walter et al. 2006): the receivers of a pixel are a tree as the lights are, and
// a cut goes through pairs of their nodes, until no pair's bound exceeds 2 % of the pixel's sum. Where the
// receivers of a pixel are alike, one of them answers for all. Rows and columns may belong to the instants of
// an open shutter: nodes then hold several, and have a representative for each (pair_cut.h).
//
// Our deviations: bounds and sums are compared by luminance. A pair is refined on the side whose node is
// larger in place and direction. A pixel's receivers weigh what they weigh in the picture; the pixel's filter
// is left to the film. Cuts are refined in rounds, several pixels side by side.
#include "methods/multidimensional_lightcuts/multidimensional_lightcuts.h"

#include <algorithm>
#include <optional>

#include "base/timer.h"
#include "matrix/entry_reader.h"
#include "methods/common/exact_rows.h"
#include "methods/common/light_tree/cut_costs.h"
#include "methods/common/turns.h"
#include "methods/multidimensional_lightcuts/pair_cut.h"
#include "methods/parameters.h"

namespace lumirank::methods {

namespace {

using matrix::Index;

struct MultidimensionalSettings {
  double error_bound = 0.02;
  std::size_t max_pairs = 2000;
};

const Fields<MultidimensionalSettings> kMultidimensionalFields{
    number_field<MultidimensionalSettings>({"error-bound", "",
                                            "A pair is refined while its bound exceeds this share of the "
                                            "pixel's sum. 0 with no limit of pairs is brute force."},
                                           &MultidimensionalSettings::error_bound, 0, 1),
    count_field<MultidimensionalSettings>({"max-pairs", "pairs", "Of a pixel's cut; time is in proportion."},
                                          &MultidimensionalSettings::max_pairs, 1, kMaxColumns)};

// Pixels whose cuts are refined side by side: neighbors, which ask for like entries.
constexpr std::size_t kPixelsTogether = 8;
// Of a first guess: cuts are found, not set.
constexpr double kPairEntriesPerRow = 300;

// Half the diagonal of the places of all lights.
float extent_scale(const LightTree& lights) {
  Bounds3f all;
  for (const LightTree::Node root : lights.roots()) {
    const matrix::ColumnSet set = lights.set(root);
    if (set.emission != matrix::Emission::directional) all.extend(set.box);
  }
  return all.radius();
}

class PixelWorkspace {
 public:
  PixelWorkspace(const matrix::LightingMatrix& matrix, const LightTree& lights, const LightInstants* instants,
                 std::uint64_t seed, const PairLimits& limits)
      : reader_(matrix.reader()) {
    const float scale = extent_scale(lights);
    for (std::size_t k = 0; k < kPixelsTogether; ++k)
      cuts_.emplace_back(lights, instants, GatherTree(matrix, seed, scale), limits);
  }

  void limit(const PairLimits& limits) {
    for (PairCut& cut : cuts_) cut.use(limits);
  }
  // At most kPixelsTogether pixels.
  void run(const RowGroups& pixels, std::size_t first, std::size_t count, std::span<Rgb> sums) {
    const Timer timer;
    double last = 0;
    const auto lap = [&](double& seconds) {
      const double now = timer.seconds();
      seconds += now - last;
      last = now;
    };
    rows_.clear(), first_place_.clear();
    for (std::size_t k = 0; k < count; ++k) {
      cuts_[k].begin(pixels[first + k]);
      first_place_.push_back(static_cast<std::uint32_t>(rows_.size()));
      rows_.insert(rows_.end(), cuts_[k].rows().begin(), cuts_[k].rows().end());
    }
    reader_->set_rows(rows_);
    for (;;) {
      places_.clear(), columns_.clear(), ends_.clear();
      bool any = false;
      for (std::size_t k = 0; k < count; ++k) {
        any = cuts_[k].request(first_place_[k], places_, columns_) || any;
        ends_.push_back(static_cast<std::uint32_t>(columns_.size()));
      }
      lap(seconds_cuts);
      if (!any) break;
      values_.resize(columns_.size());
      reader_->entries_at(places_, columns_, values_);
      costs.entries += static_cast<double>(columns_.size());
      lap(seconds_entries);
      std::uint32_t from = 0;
      for (std::size_t k = 0; k < count; ++k) {
        cuts_[k].take(std::span(values_).subspan(from, ends_[k] - from));
        from = ends_[k];
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      cuts_[k].write_sums(sums);
      const auto pairs = static_cast<double>(cuts_[k].size());
      costs.add({1, pairs, pairs, static_cast<double>(cuts_[k].bounds_computed()), 0});
    }
  }

  double seconds_cuts = 0, seconds_entries = 0;
  CutCosts costs;

 private:
  std::unique_ptr<matrix::EntryReader> reader_;
  std::vector<PairCut> cuts_;
  std::vector<Index> rows_, columns_;
  std::vector<std::uint32_t> first_place_, places_, ends_;
  std::vector<Rgb> values_;
};
using PixelPool = WorkspacePool<PixelWorkspace>;

// kPixelsTogether pixels to a row group.
RowGroups together(const RowGroups& pixels) {
  std::vector<Index> rows;
  std::vector<std::uint32_t> first;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    if (p % kPixelsTogether == 0) first.push_back(static_cast<std::uint32_t>(rows.size()));
    rows.insert(rows.end(), pixels[p].begin(), pixels[p].end());
  }
  first.push_back(static_cast<std::uint32_t>(rows.size()));
  return {std::move(rows), std::move(first)};
}

void write_pair_costs(const PixelPool& pool, const matrix::LightingMatrix& matrix, Trace& trace) {
  CutCosts costs;
  auto& numbers = trace.numbers;
  numbers["cpu_seconds.bounds"] = numbers["cpu_seconds.entries"] = 0;
  pool.for_each([&](const PixelWorkspace& w) {
    costs.add(w.costs);
    numbers["cpu_seconds.bounds"] += w.seconds_cuts;
    numbers["cpu_seconds.entries"] += w.seconds_entries;
  });
  costs.write(matrix, "cut_pairs", numbers);
}

class MultidimensionalLightcuts final : public Method {
 public:
  explicit MultidimensionalLightcuts(const MultidimensionalSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    const RunClock timer(options);
    Estimate estimate;
    estimate.sums.assign(matrix.rows(), Rgb(0));
    Turns turns(matrix, options, timer, estimate.sums);
    RowsForError rows(matrix, options, timer);
    const double before_tree = timer.seconds();
    const LightTree lights(matrix, options.seed);
    std::optional<LightInstants> instants;
    if (!matrix.column_features().instant.empty()) instants.emplace(lights, matrix);
    estimate.trace.numbers["seconds.tree"] = timer.seconds() - before_tree;
    const RowGroups pixels = RowGroups::pixels(matrix);
    {
      PixelPool pool([&] {
        return std::make_unique<PixelWorkspace>(matrix, lights, instants ? &*instants : nullptr, options.seed,
                                                PairLimits{settings_.error_bound, settings_.max_pairs});
      });
      // A coarser or a finer cut is no other draw of the same, so turns replace each other.
      const TurnMethod method{.averaged = false, .entries_per_row = kPairEntriesPerRow};
      const RowGroupResult pass = run_in_turns(
          turns, together(pixels), {options, timer, 0, "columns"}, method, estimate.sums, pool,
          [&](std::size_t group, PixelWorkspace& w, const Turn& turn, std::span<Rgb> sums) {
            const std::size_t first = group * kPixelsTogether;
            w.limit({std::min(1.0, settings_.error_bound / turn.quality), turn.scaled(settings_.max_pairs)});
            w.run(pixels, first, std::min(kPixelsTogether, pixels.size() - first), sums);
          });
      turns.write(estimate.trace);
      note_stop(pass, estimate);
      estimate.trace.numbers["seconds.columns"] = pass.seconds;
      write_pair_costs(pool, matrix, estimate.trace);
    }
    if (!estimate.interrupted)
      rows.state(estimate.sums, estimate.trace.numbers.at("columns"), estimate.trace);
    if (options.on_estimate) options.on_estimate(estimate.sums);
    return estimate;
  }

 private:
  MultidimensionalSettings settings_;
};

}  // namespace

MethodInfo multidimensional_lightcuts_info() {
  return method_info<MultidimensionalLightcuts>(
      {"multidimensional-lightcuts",
       "For each pixel a cut through pairs of its receivers and a tree of lights.",
       "Walter, Arbree, Bala, Greenberg: Multidimensional lightcuts, SIGGRAPH 2006",
       "error-bound or max-pairs",
       {.needs = {matrix::Ability::bounds},
        .sums_of_pixels = true,
        .instants = true,
        .segments = matrix::MethodContract::Segments::light_pieces}},
      kMultidimensionalFields);
}

}  // namespace lumirank::methods
