#include "methods/power_sampling/power_sampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/parallel.h"
#include "methods/common/column_pass.h"
#include "methods/common/exact_rows.h"
#include "methods/common/power_draws.h"
#include "methods/common/timed_choices.h"
#include "methods/parameters.h"

namespace lumirank::methods {

namespace {

enum class Drawing { stratified, independent };

// Rounds end when they have rendered as many columns as the matrix has: that costs what the exact sum does.
// A time that was given is used somewhat longer.
constexpr double kMaxShareOfColumns = 1, kMaxShareOfColumnsInTime = 4;
constexpr std::size_t kMaxPowerDraws = std::size_t{1} << 24;  // of an open-ended round
constexpr std::size_t kMaxDrawsOfColumn = 64;                 // in the mean: draws of one column are merged

struct PowerSamplingSettings {
  std::size_t columns = 1000;
  Drawing drawing = Drawing::stratified;
};

const Fields<PowerSamplingSettings> kPowerSamplingFields{
    count_field<PowerSamplingSettings>({"columns", "columns",
                                        "Draws with replacement; time is in proportion. With a time or error "
                                        "target it is not used: rounds are added until "
                                        "the target is met."},
                                       &PowerSamplingSettings::columns, 1, kMaxColumns),
    choice_field<PowerSamplingSettings>(
        {"drawing", "",
         "stratified: one draw in each equal part of the running sum of powers; independent: plain draws."},
        &PowerSamplingSettings::drawing, {"stratified", "independent"})};

// Sums of several rounds, weighted by their numbers of draws: every round is unbiased, so their mean is too.
class PowerSampling final : public Method {
 public:
  explicit PowerSampling(const PowerSamplingSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    const RunClock timer(options);
    RowsForError rows_for_error(matrix, options, timer);
    const bool open_ended = options.time_seconds > 0 || options.target_error > 0;
    std::vector<matrix::Index> all(matrix.columns());
    std::iota(all.begin(), all.end(), 0u);
    const auto power = matrix.column_features().power;

    // Rows tell when to stop: draws know nothing of them.
    constexpr std::size_t kRows = 64;
    const ExactRows known = options.target_error > 0 && options.time_seconds <= 0
                                ? read_rows(matrix, kRows, options.seed)
                                : ExactRows(matrix);
    const double aim =
        target_for_sampling(options.target_error, known.lights().value, known.clamping().value);

    Estimate estimate;
    estimate.sums.assign(matrix.rows(), Rgb(0));
    auto& numbers = estimate.trace.numbers;
    std::set<matrix::Index> distinct;
    std::size_t draws = 0, rendered = 0;
    double seconds = 0;
    // Without this an error that cannot be had would be pursued for ever.
    const auto max_rendered =
        static_cast<std::size_t>((options.time_seconds > 0 ? kMaxShareOfColumnsInTime : kMaxShareOfColumns) *
                                 static_cast<double>(all.size()));
    for (std::size_t round = 0;; ++round) {
      std::size_t count = !open_ended ? settings_.columns : std::max<std::size_t>(draws, 32);
      if (options.time_seconds > 0 && draws > 0) {
        const auto affordable = timed_choice(options, "affordable_draws", INT64_MAX, [&] {
          const double left = deadline_of(options) - timer.seconds();
          const double fit = left * static_cast<double>(rendered) / std::max(seconds, 1e-12);
          return static_cast<std::size_t>(std::clamp(fit, 0.0, static_cast<double>(kMaxPowerDraws)));
        });
        if (affordable == 0) break;
        // A last round that would be cut short is better made to fit.
        if (affordable < 2 * count || options.target_error <= 0) count = affordable;
      }
      if (open_ended) count = std::min({count, kMaxPowerDraws, kMaxDrawsOfColumn * all.size()});
      const auto drawn = draw_columns(
          all, power, {count, settings_.drawing == Drawing::stratified, options.seed, Stage::method, round});
      std::vector<Rgb> sums(matrix.rows(), Rgb(0));
      PassControl control{options, timer, deadline_of(options), {}};
      if (options.on_estimate && draws == 0)
        control.on_block = [&](std::span<const Rgb> part, std::size_t done) {
          options.on_estimate(scaled_sums(part, static_cast<float>(drawn.size()) / static_cast<float>(done)));
        };
      const PassResult pass = render_columns(matrix, drawn, control, sums);
      seconds += pass.seconds;
      rendered += pass.done;
      for (std::size_t k = 0; k < pass.done; ++k) distinct.insert(drawn[k].column);
      float gain = 1;
      if (pass.done < drawn.size()) {
        estimate.interrupted = pass.cancelled;
        estimate.trace.notes["stopped"] = pass.cancelled ? "cancelled" : "time budget";
        if (pass.done == 0) break;
        // What was done of the round is a fair sample of it.
        gain = static_cast<float>(drawn.size()) / static_cast<float>(pass.done);
        sums = scaled_sums(sums, gain);
        count = std::max<std::size_t>(1, count * pass.done / drawn.size());
      }
      if (draws == count) numbers["predicted_error"] = 0.5 * relative_l1_difference(sums, estimate.sums);
      add_round(estimate.sums, draws, sums, count);
      mix_in(estimate.combination, std::span(drawn).first(pass.done), gain, share_of_round(draws, count));
      draws += count;
      if (options.on_estimate) options.on_estimate(estimate.sums);
      if (estimate.interrupted || pass.out_of_time || !open_ended) break;
      if (rendered >= max_rendered) {
        if (options.target_error > 0) estimate.trace.notes["target"] = "not reached";
        break;
      }
      const auto predicted = numbers.find("predicted_error");
      if (options.target_error > 0 && predicted != numbers.end() && predicted->second < aim &&
          (options.time_seconds > 0 || known.sampling(estimate.sums).value < aim))
        break;
    }
    if (!estimate.interrupted) {
      if (known.lit())
        write_error({known.sampling(estimate.sums), known.lights(), known.clamping()}, estimate.trace);
      else
        rows_for_error.state(estimate.sums, static_cast<double>(rendered), estimate.trace);
    }
    if (options.time_seconds > 0) {
      numbers["budget.coarse_share"] = 0;  // every row has all columns that were rendered
      if (draws < settings_.columns && rendered < max_rendered && draws > 0)
        numbers["budget.seconds_wanted"] =
            1.1 * timer.seconds() * static_cast<double>(settings_.columns) / static_cast<double>(draws);
    }
    numbers["seconds.columns"] = seconds;
    numbers["rows"] = static_cast<double>(known.size());
    numbers["draws"] = static_cast<double>(draws);
    numbers["columns"] = static_cast<double>(distinct.size());
    numbers["sampling_rate"] =
        matrix.columns() > 0 ? static_cast<double>(rendered) / static_cast<double>(matrix.columns()) : 1.0;
    return estimate;
  }

 private:
  static float share_of_round(std::size_t old_draws, std::size_t draws) {
    return static_cast<float>(draws) / static_cast<float>(draws + old_draws);
  }
  static void add_round(std::span<Rgb> mean, std::size_t old_draws, std::span<const Rgb> sums,
                        std::size_t draws) {
    const float share = share_of_round(old_draws, draws);
    parallel_for(mean.size(), 16384, [&](std::size_t b, std::size_t e) {
      for (std::size_t i = b; i < e; ++i) mean[i] = old_draws == 0 ? sums[i] : lerp(mean[i], sums[i], share);
    });
  }

  PowerSamplingSettings settings_;
};

}  // namespace

MethodInfo power_sampling_info() {
  return method_info<PowerSampling>(
      {"power-sampling", "Draws columns in proportion to their lights' power.", "", "", matrix::kCombination},
      kPowerSamplingFields);
}

}  // namespace lumirank::methods
