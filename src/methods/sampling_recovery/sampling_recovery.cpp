#include "methods/sampling_recovery/sampling_recovery.h"

#include <array>

#include "methods/common/slices/slice_fields.h"
#include "methods/sampling_recovery/slice_recovery.h"
#include "methods/slice_cuts/slice_run.h"

namespace lumirank::methods {

namespace {

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

void write_recovery(const RecoveryTally& t, Trace& trace) {
  write_tally(t, "prediction", trace);
  auto& numbers = trace.numbers;
  numbers["cpu_seconds.separation"] = t.seconds_separation;
  numbers["cpu_seconds.correction"] = t.seconds_correction;
  const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
  const double slices = number(t.slices), entries = number(t.entries);
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

// What levels of visibility mean.
void set_level(const SliceLevel& level, RecoverySettings& settings) {
  static constexpr std::array<double, kVisibilityLevels> kWrong{0.2, 0.1, 0.05, 0.025, 0.0125};
  set_cut_level(level.cut, settings);
  settings.prediction_error = kWrong[level.visibility];
  settings.uncertain = 0.02 * settings.prediction_error;
  settings.rho = settings.prediction_error < 0.05 ? 0.02 : 0.01;
}

void write_level(const RecoverySettings& settings, Trace& trace) {
  write_cut_level(settings, trace);
  trace.numbers["automatic.rho"] = settings.rho;
  trace.numbers["automatic.prediction_error"] = settings.prediction_error;
  trace.numbers["automatic.uncertain"] = settings.uncertain;
}

// Each is a matrix of its own to recover, of fewer rows: eight cost what they bring.
constexpr std::size_t kDrawingsOfPasses = 4;

class SamplingRecovery final : public Method {
 public:
  explicit SamplingRecovery(const RecoverySettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    using Parameters = RecoverySettings::Parameters;
    SliceRun run(matrix, options, settings_);
    RecoverySettings settings = settings_;
    settings.drawings = drawings_of(settings.drawings, options, kDrawingsOfPasses);
    if (settings_.parameters == Parameters::automatic ||
        (settings_.parameters == Parameters::by_target && options.target_error > 0))
      search(matrix, run, settings);
    WorkspacePool<SliceRecovery> pool([&] { return std::make_unique<SliceRecovery>(run.tree(), matrix); });
    run.run(settings, false, pool);
    RecoveryTally tally;
    pool.for_each([&](const SliceRecovery& slice) { tally += slice.tally(); });
    write_recovery(tally, run.trace());
    return run.finish(tally);
  }

 private:
  void search(const matrix::LightingMatrix& matrix, SliceRun& run, RecoverySettings& settings) const {
    WorkspacePool<SliceRecovery> pool([&] { return std::make_unique<SliceRecovery>(run.tree(), matrix); });
    const auto choice = run.search(pool, true, [&](const SliceLevel& level) {
      RecoverySettings s = settings;
      set_level(level, s);
      return s;
    });
    if (!choice) return;
    set_level(choice->level, settings);
    write_level(settings, run.trace());
  }

  RecoverySettings settings_;
};

}  // namespace

MethodInfo sampling_recovery_info() {
  return method_info<SamplingRecovery>(
      {"sampling-recovery",
       "Samples few visibilities of every slice of receivers and recovers the others.",
       "Huo et al. 2015, A matrix sampling-and-recovery approach for many-lights rendering",
       "",
       {.needs = {matrix::Ability::binary_visibility, matrix::Ability::bounds},
        .segments = matrix::MethodContract::Segments::light_pieces}},
      recovery_fields());
}

}  // namespace lumirank::methods
