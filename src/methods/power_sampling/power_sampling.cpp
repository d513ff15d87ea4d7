#include "methods/power_sampling/power_sampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
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
class PowerRounds {
 public:
  PowerRounds(const PowerSamplingSettings& settings, const matrix::LightingMatrix& matrix,
              const RunOptions& options)
      : settings_(settings),
        matrix_(matrix),
        options_(options),
        timer_(options),
        rows_for_error_(matrix, options, timer_),
        open_ended_(options.time_seconds > 0 || options.target_error > 0),
        all_(matrix.columns()),
        known_(options.target_error > 0 && options.time_seconds <= 0
                   ? read_rows(matrix, kRowsOfTarget, options.seed)
                   : ExactRows(matrix)),
        aim_(target_for_sampling(options.target_error, known_.lights().value, known_.clamping().value)),
        max_rendered_(static_cast<std::size_t>(
            (options.time_seconds > 0 ? kMaxShareOfColumnsInTime : kMaxShareOfColumns) *
            static_cast<double>(matrix.columns()))) {
    std::iota(all_.begin(), all_.end(), 0u);
    estimate_.sums.assign(matrix.rows(), Rgb(0));
  }

  Estimate run() {
    for (std::size_t round = 0;; ++round) {
      const auto count = draws_of_round();
      if (!count || !add_round(round, *count)) break;
    }
    state_error();
    write_numbers();
    return std::move(estimate_);
  }

 private:
  static constexpr std::size_t kRowsOfTarget = 64;

  // None where time is up.
  std::optional<std::size_t> draws_of_round() const {
    std::size_t count = !open_ended_ ? settings_.columns : std::max<std::size_t>(draws_, 32);
    if (options_.time_seconds > 0 && draws_ > 0) {
      const auto affordable = timed_choice(options_, "affordable_draws", INT64_MAX, [&] {
        const double left = deadline_of(options_) - timer_.seconds();
        const double fit = left * static_cast<double>(rendered_) / std::max(seconds_, 1e-12);
        return static_cast<std::size_t>(std::clamp(fit, 0.0, static_cast<double>(kMaxPowerDraws)));
      });
      if (affordable == 0) return std::nullopt;
      // A last round that would be cut short is better made to fit.
      if (affordable < 2 * count || options_.target_error <= 0) count = affordable;
    }
    if (open_ended_) count = std::min({count, kMaxPowerDraws, kMaxDrawsOfColumn * all_.size()});
    return count;
  }

  // Whether another one follows.
  bool add_round(std::size_t round, std::size_t count) {
    const auto drawn =
        draw_columns(all_, matrix_.column_features().power,
                     {count, settings_.drawing == Drawing::stratified, options_.seed, Stage::method, round});
    std::vector<Rgb> sums(matrix_.rows(), Rgb(0));
    const PassResult pass = render(drawn, sums);
    float gain = 1;
    if (pass.done < drawn.size()) {
      estimate_.interrupted = pass.cancelled;
      estimate_.trace.notes["stopped"] = pass.cancelled ? "cancelled" : "time budget";
      if (pass.done == 0) return false;
      // What was done of the round is a fair sample of it.
      gain = static_cast<float>(drawn.size()) / static_cast<float>(pass.done);
      sums = scaled_sums(sums, gain);
      count = std::max<std::size_t>(1, count * pass.done / drawn.size());
    }
    if (draws_ == count)
      estimate_.trace.numbers["predicted_error"] = 0.5 * relative_l1_difference(sums, estimate_.sums);
    const float share = static_cast<float>(count) / static_cast<float>(count + draws_);
    mix_in_sums(sums, share);
    mix_in(estimate_.combination, std::span(drawn).first(pass.done), gain, share);
    draws_ += count;
    if (options_.on_estimate) options_.on_estimate(estimate_.sums);
    return !estimate_.interrupted && !pass.out_of_time && open_ended_ && !enough();
  }

  PassResult render(std::span<const matrix::ScaledColumn> drawn, std::span<Rgb> sums) {
    PassControl control{options_, timer_, deadline_of(options_), {}};
    if (options_.on_estimate && draws_ == 0)
      control.on_block = [&](std::span<const Rgb> part, std::size_t done) {
        options_.on_estimate(scaled_sums(part, static_cast<float>(drawn.size()) / static_cast<float>(done)));
      };
    const PassResult pass = render_columns(matrix_, drawn, control, sums);
    seconds_ += pass.seconds;
    rendered_ += pass.done;
    for (std::size_t k = 0; k < pass.done; ++k) distinct_.insert(drawn[k].column);
    return pass;
  }

  void mix_in_sums(std::span<const Rgb> sums, float share) {
    std::vector<Rgb>& mean = estimate_.sums;
    parallel_for(mean.size(), 16384, [&](std::size_t b, std::size_t e) {
      for (std::size_t i = b; i < e; ++i) mean[i] = draws_ == 0 ? sums[i] : lerp(mean[i], sums[i], share);
    });
  }

  // Whether the target is met, or the rounds have cost what they may: without that, an error that cannot be
  // had would be pursued for ever.
  bool enough() {
    if (rendered_ >= max_rendered_) {
      if (options_.target_error > 0) estimate_.trace.notes["target"] = "not reached";
      return true;
    }
    const auto& numbers = estimate_.trace.numbers;
    const auto predicted = numbers.find("predicted_error");
    return options_.target_error > 0 && predicted != numbers.end() && predicted->second < aim_ &&
           (options_.time_seconds > 0 || known_.sampling(estimate_.sums).value < aim_);
  }

  void state_error() {
    if (estimate_.interrupted) return;
    if (known_.lit())
      write_error({known_.sampling(estimate_.sums), known_.lights(), known_.clamping()}, estimate_.trace);
    else
      rows_for_error_.state(estimate_.sums, static_cast<double>(rendered_), estimate_.trace);
  }

  void write_numbers() {
    auto& numbers = estimate_.trace.numbers;
    if (options_.time_seconds > 0) {
      numbers["budget.coarse_share"] = 0;  // every row has all columns that were rendered
      if (draws_ < settings_.columns && rendered_ < max_rendered_ && draws_ > 0)
        numbers["budget.seconds_wanted"] =
            1.1 * timer_.seconds() * static_cast<double>(settings_.columns) / static_cast<double>(draws_);
    }
    numbers["seconds.columns"] = seconds_;
    numbers["rows"] = static_cast<double>(known_.size());
    numbers["draws"] = static_cast<double>(draws_);
    numbers["columns"] = static_cast<double>(distinct_.size());
    numbers["sampling_rate"] =
        matrix_.columns() > 0 ? static_cast<double>(rendered_) / static_cast<double>(matrix_.columns()) : 1.0;
  }

  const PowerSamplingSettings& settings_;
  const matrix::LightingMatrix& matrix_;
  const RunOptions& options_;
  const RunClock timer_;
  RowsForError rows_for_error_;
  const bool open_ended_;  // until a target is met
  std::vector<matrix::Index> all_;
  const ExactRows known_;  // rows that tell when to stop: draws know nothing of them
  const double aim_;
  const std::size_t max_rendered_;

  Estimate estimate_;
  std::set<matrix::Index> distinct_;
  std::size_t draws_ = 0, rendered_ = 0;
  double seconds_ = 0;
};

class PowerSampling final : public Method {
 public:
  explicit PowerSampling(const PowerSamplingSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    return PowerRounds(settings_, matrix, options).run();
  }

 private:
  PowerSamplingSettings settings_;
};

}  // namespace

MethodInfo power_sampling_info() {
  return method_info<PowerSampling>(
      {"power-sampling", "Draws columns in proportion to their lights' power.", "", "", matrix::kCombination},
      kPowerSamplingFields);
}

}  // namespace lumirank::methods
