#include "methods/slices/slice_pass.h"

#include <algorithm>

#include "methods/known_rows.h"

namespace lumirank::methods {

namespace {
Estimate dark(std::size_t rows) {
  Estimate estimate;
  estimate.sums.assign(rows, Rgb(0));
  return estimate;
}
}  // namespace

SlicePass::SlicePass(const matrix::LightingMatrix& matrix, const RunOptions& options,
                     const SliceLightSettings& settings)
    : matrix_(matrix),
      options_(options),
      estimate_(dark(matrix.rows())),
      lights_(matrix, options, settings, estimate_.sums) {
  result_.cancelled = !lights_.ready();
  if (lights_.ready() && options.on_estimate) options.on_estimate(estimate_.sums);
}

// Slices take turns of as many as there are threads. A tenth is kept back for turns that take longer.
std::size_t SlicePass::columns_that_fit(std::size_t slices, std::size_t tried,
                                        const SliceCosts& trial) const {
  constexpr double kShare = 0.9, kLeastSeconds = 1e-12;
  if (tried == 0) return 0;
  const auto threads = static_cast<std::size_t>(current_threads());
  const double turns = static_cast<double>((slices + threads - 1) / threads), n = static_cast<double>(tried);
  const double turn = kShare * (options_.time_seconds - timer_.seconds()) / turns;
  const double column =
      trial.seconds_columns / n / static_cast<double>(std::max<std::uint64_t>(trial.most_columns, 1));
  const double fitting = (turn - trial.seconds_clustering / n) / std::max(column, kLeastSeconds);
  return static_cast<std::size_t>(std::clamp(fitting, 0.0, static_cast<double>(lights_.most_columns())));
}

Estimate SlicePass::finish() {
  auto& numbers = estimate_.trace.numbers;
  const double rows = static_cast<double>(matrix_.rows()), columns = static_cast<double>(matrix_.columns());
  const double entries = static_cast<double>(costs_.entries),
               read = static_cast<double>(lights_.known().size());
  numbers["seconds.rows"] = lights_.seconds_rows();
  numbers["seconds.clustering"] = lights_.seconds_clustering();
  numbers["seconds.columns"] = result_.seconds;
  numbers["cpu_seconds.clustering"] = costs_.seconds_clustering;
  numbers["cpu_seconds.columns"] = costs_.seconds_columns;
  numbers["slices"] = static_cast<double>(lights_.slices().count());
  numbers["rows"] = read;
  numbers["columns"] = rows > 0 ? entries / rows : 0;
  numbers["columns_max"] = static_cast<double>(costs_.most_columns);
  numbers["memory.reduced_bytes"] = static_cast<double>(lights_.memory_bytes());
  numbers["sampling_rate"] = rows * columns > 0 ? (entries + read * columns) / (rows * columns) : 1.0;
  note_stop(result_, estimate_);
  if (lights_.ready())
    write_error_of_lights({{}, lights_.known().lights(), lights_.known().clamping()}, estimate_.trace);
  if (!estimate_.interrupted) {
    look_at_rows(matrix_, options_, estimate_.sums, numbers["columns"] + read, estimate_.trace);
    if (options_.on_estimate) options_.on_estimate(estimate_.sums);
  }
  return std::move(estimate_);
}

}  // namespace lumirank::methods
