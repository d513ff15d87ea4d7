#include "methods/sampling_recovery/sampling_recovery.h"

#include <algorithm>

#include "base/error.h"
#include "base/random.h"
#include "methods/common/exact_rows.h"
#include "methods/common/row_group_pass.h"
#include "methods/common/slices/slice_lights.h"
#include "methods/common/slices/slice_pass.h"
#include "methods/common/slices/slices.h"
#include "methods/common/turns.h"
#include "methods/sampling_recovery/automatic.h"
#include "methods/sampling_recovery/settings.h"
#include "methods/sampling_recovery/slice_recovery.h"

namespace lumirank::methods {

namespace {

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

// Under a budget there are at least so many slices, unless one would be smaller than this.
constexpr std::size_t kSlicesForTurns = 32, kPixelsForTurns = 128;
constexpr std::uint64_t kKey = 0x5245434f;  // of random numbers
// A slice's row costs as much as 1/slices of its columns, so even small pictures afford some.
constexpr RowsForError::Share kErrorOfSlices{0.08, 8};

// traced: nothing was predicted, separated or corrected.
void write_tally(const RecoveryTally& t, bool traced, Trace& trace) {
  auto& numbers = trace.numbers;
  for (std::size_t k = 0; k < t.seconds.size(); ++k) {
    const std::string step = RecoveryTally::kSteps[k];
    const bool recovers = step == "separation" || step == "correction";
    if (!traced || !recovers)
      numbers["cpu_seconds." + (traced && step == "prediction" ? "visibility" : step)] = t.seconds[k];
  }
  const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
  const double slices = number(t.slices), entries = number(t.entries);
  numbers["columns"] = ratio(number(t.columns), slices);
  numbers["columns_max"] = number(t.columns_most);
  numbers["sampling_rate"] = entries > 0 ? number(t.sampled) / entries : 1.0;
  numbers["samples_per_row"] = ratio(number(t.sampled), number(t.rows));
  if (traced) return;
  numbers["sampled_uncertain"] = ratio(number(t.uncertain), entries);
  numbers["corrected"] = ratio(number(t.corrected), entries);
  numbers["rank"] = ratio(number(t.rank), slices);
  numbers["iterations"] = ratio(number(t.iterations), slices);
  numbers["converged"] = ratio(number(t.converged), slices);
  for (std::size_t k = 0; k < t.converged_after.size(); ++k)
    if (t.converged_after[k] > 0)
      numbers["converged_after." + std::to_string(k)] = number(t.converged_after[k]) / slices;
  for (std::size_t k = 0; k < t.residual.size(); ++k)
    numbers["residual." + std::to_string(k + 1)] = t.residual[k] / slices;
  const char* const names[] = {"nearest", "plane", "bayes"};
  for (std::size_t k = 0; k < 3; ++k)
    numbers[std::string("predictor.") + names[k]] = ratio(number(t.prediction.chosen[k]), number(t.columns));
  numbers["predictor.failed"] = ratio(number(t.prediction.failed), number(t.columns));
  numbers["prediction_error"] = ratio(t.prediction.error, number(t.columns));
  numbers["rounds"] = ratio(number(t.prediction.rounds), number(t.columns));
}

void write_choice(const AutomaticChoice& choice, Trace& trace) {
  auto& numbers = trace.numbers;
  numbers["automatic.alpha"] = choice.settings.alpha;
  numbers["automatic.rho"] = choice.settings.rho;
  numbers["automatic.prediction_error"] = choice.settings.prediction_error;
  numbers["automatic.uncertain"] = choice.settings.uncertain;
  numbers["automatic.initial_columns"] = static_cast<double>(choice.settings.initial_columns);
  numbers["automatic.error"] = choice.error;
  numbers["automatic.target"] = choice.target;
  numbers["automatic.trials"] = static_cast<double>(choice.trials);
}

class SamplingRecovery : public Method {
 public:
  explicit SamplingRecovery(const RecoverySettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    const bool search =
        settings_.parameters == RecoverySettings::Parameters::automatic ||
        (settings_.parameters == RecoverySettings::Parameters::by_target && options.target_error > 0);
    if (settings_.clusters == RecoverySettings::Clusters::rows) {
      if (search)
        throw InputError("no parameters can be found for a target error with clusters=rows",
                         "use clusters=bounds, or parameters=given without a target");
      return by_rows(matrix, options);
    }
    return by_bounds(matrix, options, search);
  }

 private:
  struct Workspace {
    Workspace(const RecoverySettings& settings, const matrix::LightingMatrix& matrix)
        : recovery(settings, nullptr, matrix) {}
    SliceRecovery recovery;
    SliceLights::Workspace lights;
    SliceCosts costs;
  };

  Estimate by_rows(const matrix::LightingMatrix& matrix, const RunOptions& options) const {
    SliceLightSettings lights;
    lights.columns = settings_.columns;
    lights.neighbours = settings_.neighbours;
    lights.slice_rows = most_receivers(matrix, false);
    WorkspacePool<Workspace> pool([&] { return std::make_unique<Workspace>(settings_, matrix); });
    Estimate estimate =
        run_slices(matrix, options, lights, pool,
                   [&](const SliceLights& slices, std::size_t s, Workspace& w, std::span<Rgb> sums) {
                     w.recovery.run(slices.slices().slice(s), w.lights.chosen,
                                    hash_ids(options.seed, Stage::method, kKey, s), sums);
                   });
    RecoveryTally tally;
    pool.for_each([&](const Workspace& w) { tally += w.recovery.tally(); });
    write_tally(tally, traced(), estimate.trace);
    return estimate;
  }

  Estimate by_bounds(const matrix::LightingMatrix& matrix, const RunOptions& options, bool search) const {
    const RunClock timer(options);
    Estimate estimate;
    estimate.sums.assign(matrix.rows(), Rgb(0));
    Turns turns(matrix, options, timer, estimate.sums);
    RowsForError rows(matrix, options, timer);
    const double before_tree = timer.seconds();
    auto& numbers = estimate.trace.numbers;
    const LightTree tree(matrix, options.seed);
    numbers["seconds.tree"] = timer.seconds() - before_tree;
    const Slices slices =
        make_slices(matrix.row_features(), matrix.rows(), most_receivers(matrix, options.time_seconds > 0));
    numbers["seconds.slices"] = timer.seconds() - before_tree - numbers["seconds.tree"];
    numbers["slices"] = static_cast<double>(slices.count());
    numbers["rows"] = static_cast<double>(rows.size());
    RecoverySettings settings = settings_;
    // With a time, the time decides.
    if (search && options.time_seconds <= 0) {
      const double before = timer.seconds();
      const AutomaticChoice choice = choose_parameters(settings_, tree, matrix, slices, options);
      settings = choice.settings;
      write_choice(choice, estimate.trace);
      numbers["seconds.parameters"] = timer.seconds() - before;
      numbers["rows"] = static_cast<double>(choice.rows);
    }

    WorkspacePool<SliceRecovery> pool(
        [&] { return std::make_unique<SliceRecovery>(settings, &tree, matrix); });
    const UnitRows units(slices.rows, slices.first);
    TurnMethod method{.phase = "slices", .entries_per_row = static_cast<double>(settings.initial_columns)};
    method.exact_from =
        traced() ? ratio(static_cast<double>(matrix.columns()),
                         static_cast<double>(std::min(settings.initial_columns, settings.most_columns)))
                 : 0;
    const UnitResult result = run_in_turns(
        turns, units, {options, timer, 0, method.phase}, method, estimate.sums, pool,
        [&](std::size_t s, SliceRecovery& slice, const Turn& turn, std::span<Rgb> sums) {
          slice.use(settings.at(turn));
          slice.run(slices.slice(s), hash_ids(options.seed, Stage::method, kKey + turn.number, s), sums);
        });
    turns.write(estimate.trace);
    RecoveryTally tally;
    pool.for_each([&](const SliceRecovery& slice) { tally += slice.tally(); });
    numbers["seconds.columns"] = result.seconds;
    write_tally(tally, traced(), estimate.trace);
    note_stop(result, estimate);
    if (!estimate.interrupted) {
      rows.state(estimate.sums, ratio(static_cast<double>(tally.shades), static_cast<double>(matrix.rows())),
                 kErrorOfSlices, estimate.trace);
      if (options.on_estimate) options.on_estimate(estimate.sums);
    }
    return estimate;
  }

  bool traced() const { return settings_.visibility == RecoverySettings::Visibility::traced; }
  // Slices are cut by receivers, of which a pixel has several. Where little of the picture is to be lit,
  // those of the usual size are too few to be refined by the clock: a turn ends with some of them.
  std::size_t most_receivers(const matrix::LightingMatrix& matrix, bool timed) const {
    const std::size_t pixels = UnitRows::pixels(matrix).size();
    const std::size_t per_pixel = pixels > 0 ? (matrix.rows() + pixels / 2) / pixels : 1;
    std::size_t rows = settings_.slice_rows;
    if (timed && rows == RecoverySettings{}.slice_rows)  // not set by hand
      rows = std::min(rows, std::max(kPixelsForTurns, pixels / kSlicesForTurns));
    return rows * std::max<std::size_t>(per_pixel, 1);
  }

  RecoverySettings settings_;
};

// Shadow rays in packets cost so little that looking at all of a slice's visibilities, one for each surface
// of a pixel, takes no longer than recovering them (docs/measurements.md), and leaves the error of the
// clusters alone.
class SliceCuts final : public SamplingRecovery {
 public:
  explicit SliceCuts(const RecoverySettings& settings) : SamplingRecovery(with_traced(settings)) {}

 private:
  static RecoverySettings with_traced(RecoverySettings settings) {
    settings.visibility = RecoverySettings::Visibility::traced;
    return settings;
  }
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
       {{matrix::Ability::bounds}}},
      slice_cut_fields());
}

MethodInfo sampling_recovery_info() {
  return method_info<SamplingRecovery>(
      {"sampling-recovery",
       "Samples few visibilities of every slice of receivers and recovers the others.",
       "Huo et al. 2015, A matrix sampling-and-recovery approach for many-lights rendering",
       "",
       {{matrix::Ability::binary_visibility, matrix::Ability::bounds}}},
      recovery_fields());
}

}  // namespace lumirank::methods
