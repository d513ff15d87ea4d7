#include "methods/common/slices/slice_pass.h"

#include <algorithm>

#include "methods/common/exact_rows.h"

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
      clock_(options),
      estimate_(dark(matrix.rows())),
      turns_(matrix, options, clock_, estimate_.sums),
      rows_(matrix, options, clock_),
      row_sums_(options.time_seconds > 0 ? matrix.rows() : 0),
      lights_(matrix, options, clock_, rows_.row_seconds(), settings,
              options.time_seconds > 0 ? std::span<Rgb>(row_sums_) : std::span<Rgb>(estimate_.sums)),
      given_columns_(std::min(settings.columns, std::max<std::size_t>(matrix.columns(), 1))) {
  result_.cancelled = options.sinks.cancelled();
  result_.out_of_time = !lights_.ready() && !result_.cancelled;
  if (lights_.ready() && options.on_estimate && options.time_seconds <= 0)
    options.on_estimate(estimate_.sums);
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
  numbers["columns_max"] = static_cast<double>(costs_.max_columns);
  numbers["memory.reduced_bytes"] = static_cast<double>(lights_.memory_bytes());
  numbers["sampling_rate"] = rows * columns > 0 ? (entries + read * columns) / (rows * columns) : 1.0;
  turns_.write(estimate_.trace);
  note_stop(result_, estimate_);
  if (lights_.ready() && lights_.known().lit())
    write_error_of_lights({{}, lights_.known().lights(), lights_.known().clamping()}, estimate_.trace);
  if (!estimate_.interrupted) {
    rows_.state(estimate_.sums, numbers["columns"] + read, {0.08, 8}, estimate_.trace);
    if (options_.on_estimate) options_.on_estimate(estimate_.sums);
  }
  return std::move(estimate_);
}

}  // namespace lumirank::methods
