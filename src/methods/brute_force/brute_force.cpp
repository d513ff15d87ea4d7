#include "methods/brute_force/brute_force.h"

#include <algorithm>

#include "methods/common/column_pass.h"
#include "methods/common/exact_rows.h"
#include "methods/parameters.h"

namespace lumirank::methods {

namespace {

struct NoSettings {};
const Fields<NoSettings> kBruteForceFields{};

class BruteForce final : public Method {
 public:
  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    return sum_all_columns_and_look(matrix, options);
  }
};

// Columns 0, s, 2s, …, 1, s+1, …: lights of one kind lie together, so strides spread every prefix over all
// kinds.
std::vector<matrix::ScaledColumn> strided(std::size_t n) {
  const std::size_t stride = std::max<std::size_t>(1, n / 64);
  std::vector<matrix::ScaledColumn> columns;
  columns.reserve(n);
  for (std::size_t first = 0; first < stride; ++first)
    for (std::size_t j = first; j < n; j += stride)
      columns.push_back({static_cast<matrix::Index>(j), Rgb(1)});
  return columns;
}

}  // namespace

Estimate sum_all_columns(const matrix::LightingMatrix& matrix, const RunOptions& options) {
  const RunClock timer(options);
  const std::size_t n = matrix.columns();
  const auto columns = strided(n);
  Estimate estimate;
  estimate.sums.assign(matrix.rows(), Rgb(0));
  PassControl control{options, timer, deadline_of(options), {}};
  if (options.on_estimate)
    control.on_block = [&](std::span<const Rgb> sums, std::size_t done) {
      options.on_estimate(scaled_sums(sums, static_cast<float>(n) / static_cast<float>(done)));
    };
  const PassResult pass = render_columns(matrix, columns, control, estimate.sums);
  float gain = 1;
  if (pass.done < n) {
    const double scale = pass.done > 0 ? static_cast<double>(n) / static_cast<double>(pass.done) : 0.0;
    gain = static_cast<float>(scale);
    estimate.sums = scaled_sums(estimate.sums, gain);
    estimate.trace.notes["stopped"] = pass.cancelled ? "cancelled" : "time budget";
  }
  if (options.time_seconds > 0) {
    estimate.trace.numbers["budget.coarse_share"] = 0;  // every row has all columns that were rendered
    if (pass.out_of_time && pass.done > 0)
      estimate.trace.numbers["budget.seconds_wanted"] =
          1.1 * pass.seconds * static_cast<double>(n) / static_cast<double>(pass.done);
  }
  mix_in(estimate.combination, std::span(columns).first(pass.done), gain, 1);
  estimate.interrupted = pass.cancelled;
  estimate.trace.numbers["seconds.columns"] = pass.seconds;
  estimate.trace.numbers["rows"] = 0;
  estimate.trace.numbers["columns"] = static_cast<double>(pass.done);
  estimate.trace.numbers["sampling_rate"] =
      n > 0 ? static_cast<double>(pass.done) / static_cast<double>(n) : 1.0;
  if (options.on_estimate) options.on_estimate(estimate.sums);
  return estimate;
}

Estimate sum_all_columns_and_look(const matrix::LightingMatrix& matrix, const RunOptions& options) {
  const RunClock clock(options);
  RowsForError rows(matrix, options, clock);
  RunOptions rest = options;
  if (options.time_seconds > 0) rest.time_seconds = std::max(options.time_seconds - clock.seconds(), 1e-9);
  Estimate estimate = sum_all_columns(matrix, rest);
  if (!estimate.interrupted) rows.state(estimate.sums, estimate.trace.numbers.at("columns"), estimate.trace);
  return estimate;
}

MethodInfo brute_force_info() {
  return {"brute-force",
          "Renders every column: exact for the given lights, and slow.",
          "",
          parameters_of(kBruteForceFields),
          [](const SettingsMap& settings) -> std::unique_ptr<Method> {
            read_settings("brute-force", kBruteForceFields, settings);
            return std::make_unique<BruteForce>();
          },
          [](const SettingsMap&) -> std::size_t { return 0; },
          "",
          matrix::kCombination};
}

}  // namespace lumirank::methods
