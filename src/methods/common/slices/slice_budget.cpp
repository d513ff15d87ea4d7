#include "methods/common/slices/slice_budget.h"

#include <algorithm>

#include "methods/common/timed_choices.h"

namespace lumirank::methods {

namespace {

using matrix::Index;

constexpr std::size_t kMinSliceRows = 128,
                      kMaxRowsFound = 4096;  // of a slice, where their number is found

constexpr double kPlanned = 0.6;  // of the time: the rest is for what clusters cost beyond a guess

// Of the columns that are allowed, those that are taken where an error decides.
constexpr double kTaken = 1.0 / 6;

// Reading a row costs an entry per column, rendering a slice's columns `columns` per row.
std::size_t slice_rows(const SliceLightSettings& settings, std::size_t columns) {
  if (settings.slice_rows > 0) return settings.slice_rows;
  const double taken = static_cast<double>(settings.columns) * (settings.enough > 0 ? kTaken : 1.0);
  const double rows = static_cast<double>(columns) / std::max(taken, 1.0);
  return std::clamp(static_cast<std::size_t>(rows), kMinSliceRows, kMaxRowsFound);
}

// Seconds of a row: the fastest of three spread over the matrix, since the first warms caches.
double seconds_of_row(const matrix::LightingMatrix& matrix, const RunClock& clock) {
  std::vector<Rgb> values(matrix.columns());
  double fastest = 1e9;
  for (const std::size_t sixths : {1u, 3u, 5u}) {
    const double before = clock.seconds();
    matrix.row(static_cast<Index>(matrix.rows() * sixths / 6), values);
    fastest = std::min(fastest, clock.seconds() - before);
  }
  return fastest;
}

}  // namespace

SliceLightSettings with_slice_rows(SliceLightSettings settings, const matrix::LightingMatrix& matrix,
                                   const RunOptions& options, const RunClock& clock, double row_seconds) {
  settings.slice_rows = slice_rows(settings, matrix.columns());
  if (options.time_seconds <= 0 || matrix.rows() == 0 || matrix.columns() == 0) return settings;
  const std::size_t columns = std::min(settings.columns, matrix.columns()),
                    slices = (matrix.rows() + settings.slice_rows - 1) / settings.slice_rows;
  const std::size_t fitting =
      timed_choice(options, "slices", static_cast<std::int64_t>(slices), [&]() -> std::size_t {
        const double row = row_seconds > 0 ? row_seconds : seconds_of_row(matrix, clock);
        const double all = row * (2 * static_cast<double>(slices) +
                                  static_cast<double>(matrix.rows()) * static_cast<double>(columns) /
                                      static_cast<double>(matrix.columns()));
        const double left = kPlanned * std::max(deadline_of(options) - clock.seconds(), 0.0);
        return all <= left ? slices : static_cast<std::size_t>(static_cast<double>(slices) * left / all);
      });
  if (fitting >= slices) return settings;
  const std::size_t count = std::max<std::size_t>(fitting, 1);
  settings.slice_rows = (matrix.rows() + count - 1) / count;
  settings.columns = std::max<std::size_t>(columns * count / slices, 1);
  return settings;
}

}  // namespace lumirank::methods
