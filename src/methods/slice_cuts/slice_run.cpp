#include "methods/slice_cuts/slice_run.h"

#include <algorithm>

#include "base/random.h"

namespace lumirank::methods {

namespace {

// Under a budget there are at least so many slices, unless one would be smaller than this.
constexpr std::size_t kSlicesForTurns = 32, kPixelsForTurns = 128;
// A slice's row costs as much as 1/slices of its columns, so even small pictures afford some.
constexpr RowsForError::Share kErrorOfSlices{0.08, 8};

Estimate dark_estimate(std::size_t rows) {
  Estimate estimate;
  estimate.sums.assign(rows, Rgb(0));
  return estimate;
}

}  // namespace

std::uint64_t slice_key(std::uint64_t seed, std::size_t slice, std::uint64_t turn) {
  constexpr std::uint64_t kKey = 0x5245434f;
  return hash_ids(seed, Stage::method, kKey + turn, slice);
}

std::size_t max_slice_receivers(const matrix::LightingMatrix& matrix, std::size_t slice_rows, bool timed) {
  const std::size_t pixels = RowGroups::pixels(matrix).size();
  const std::size_t per_pixel = pixels > 0 ? (matrix.rows() + pixels / 2) / pixels : 1;
  std::size_t rows = slice_rows;
  if (timed && rows == SliceCutSettings{}.slice_rows)  // not set by hand
    rows = std::min(rows, std::max(kPixelsForTurns, pixels / kSlicesForTurns));
  return rows * std::max<std::size_t>(per_pixel, 1);
}

SliceRun::SliceRun(const matrix::LightingMatrix& matrix, const RunOptions& options,
                   const SliceCutSettings& settings)
    : matrix_(matrix),
      options_(options),
      clock_(options),
      estimate_(dark_estimate(matrix.rows())),
      turns_(matrix, options, clock_, estimate_.sums),
      rows_(matrix, options, clock_) {
  auto& numbers = estimate_.trace.numbers;
  const double before = clock_.seconds();
  tree_.emplace(matrix, options.seed);
  numbers["seconds.tree"] = clock_.seconds() - before;
  slices_ = make_slices(matrix.row_features(), matrix.rows(),
                        max_slice_receivers(matrix, settings.slice_rows, options.time_seconds > 0),
                        {static_cast<float>(settings.overlap), options.seed});
  numbers["seconds.slices"] = clock_.seconds() - before - numbers["seconds.tree"];
  numbers["slices"] = static_cast<double>(slices_.count());
  numbers["rows"] = static_cast<double>(rows_.size());
}

std::optional<LevelChoice> SliceRun::search(const LevelTrials& trials) {
  const double before = clock_.seconds();
  const LevelChoice choice = choose_level(matrix_, slices_, options_, trials);
  if (choice.trials == 0) return std::nullopt;
  auto& numbers = estimate_.trace.numbers;
  numbers["automatic.error"] = choice.error;
  numbers["automatic.target"] = choice.target;
  numbers["automatic.trials"] = static_cast<double>(choice.trials);
  numbers["seconds.parameters"] = clock_.seconds() - before;
  numbers["rows"] = static_cast<double>(choice.rows);
  return choice;
}

Estimate SliceRun::finish(const SliceTally& tally) {
  turns_.write(estimate_.trace);
  estimate_.trace.numbers["seconds.columns"] = result_.seconds;
  note_stop(result_, estimate_);
  if (!estimate_.interrupted) {
    const std::size_t rows = matrix_.rows();
    rows_.state(estimate_.sums, rows > 0 ? static_cast<double>(tally.shades) / static_cast<double>(rows) : 0,
                kErrorOfSlices, estimate_.trace);
    if (options_.on_estimate) options_.on_estimate(estimate_.sums);
  }
  return std::move(estimate_);
}

}  // namespace lumirank::methods
