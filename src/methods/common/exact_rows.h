// Rows that were read whole. There the sum over all columns is known, and for nothing also how far it is from
// the sum over infinitely many: what the two halves of the columns disagree by, and what clamping took away.
// A sample of such rows tells the error of an image and its parts.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "matrix/lighting_matrix.h"
#include "methods/common/run_clock.h"
#include "methods/method.h"

namespace lumirank::methods {

struct SampledRow {
  matrix::Index row;
  float weight;  // √(block size × number of blocks / rows): makes Σ|weight × entry|² unbiased for the mean
                 // square of a column
};

struct ExactRow {
  SampledRow from;
  double share;         // of an image's light: weight² × the row's weight in the image
  Rgb sum;              // of all columns
  Rgb half_difference;  // |sum over half 1 − sum over half 2| of the columns, per channel
  double clamped;       // r + g + b that clamping took away for good
};

// A relative L1 error, and the half width of its 95 % interval: by the delete-a-group jackknife over 16
// groups of rows. The interval knows of the choice of rows, not of that of the lights.
//
// low … high: an interval for errors with a heavy tail, a few rows that are far off, which the symmetric one
// misses on the high side: from bootstrapped t values (Efron and Tibshirani 1993, section 12.5) between 2.5 %
// and 99 %, the upper end further out because t values of few rows of a heavy tail are short of their own.
// It is stated at 90 % (kErrorConfidence), which it keeps for rows that err as log-normal deviates with σ
// ≤ 1.5 do. Of a kind of rows rarer than one in as many as were read, no interval knows.
struct ErrorPart {
  double value = 0, half_width = 0;
  double low = 0, high = 0;
};
inline constexpr double kErrorConfidence = 0.9;

// Relative to what infinitely many unclamped columns are estimated to add up to.
struct ErrorParts {
  ErrorPart sampling;  // estimate against the sum of all columns
  ErrorPart lights;    // their number: the sum of all against the limit, without clamping
  ErrorPart clamping;  // a loss, so it adds in full
  // √(sampling² + lights²) + clamping: the first two are independent of each other and of mean 0.
  ErrorPart total() const;
};

class ExactRows {
 public:
  explicit ExactRows(const matrix::LightingMatrix& matrix) : matrix_(&matrix) {}

  // Evaluates the row into `values` (one per column) and keeps what the errors need.
  const ExactRow& read(const SampledRow& row, std::span<Rgb> values);
  void append(const ExactRows& others);
  void add(const ExactRow& row) { rows_.push_back(row); }

  std::span<const ExactRow> rows() const { return rows_; }
  std::size_t size() const { return rows_.size(); }
  // Whether any of them has light: errors are relative to it.
  bool lit() const;

  // The sum of independent halves 2A and 2B is off by (2A − 2B)/2 as often as by its true error: both have
  // the variance of (2A + 2B)/2. For sums of many columns E|·| agrees as well; where few columns matter it is
  // up to half too small.
  ErrorPart lights() const;
  ErrorPart clamping() const;
  // Of `sums` (one per row of the matrix). Honest only at rows that took no part in them.
  ErrorPart sampling(std::span<const Rgb> sums) const;

 private:
  template <typename Error>
  ErrorPart relative(Error&& error) const;

  const matrix::LightingMatrix* matrix_;
  std::vector<ExactRow> rows_;
};

// error.estimate, error.sampling, error.lights, error.clamping and their half widths; or the last two alone.
void write_error(const ErrorParts& parts, Trace& trace);
void write_error_of_lights(const ErrorParts& parts, Trace& trace);

// What may be left to sampling for the whole error to be `target`. Where the other parts leave too little
// (less than a quarter of it), no number of columns helps: then half of the target, which adds little to
// them.
double target_for_sampling(double target, double lights, double clamping);

// `count` stratified rows, read.
ExactRows read_rows(const matrix::LightingMatrix& matrix, std::size_t count, std::uint64_t seed);

// Rows by which methods that read none state their error: they take no part in the sums.
//
// Without a budget they are read afterwards: 64 if an error is asked for, otherwise as many as the given
// share of the entries already spent pays for, or none if those are fewer than `fewest`. With one they are
// read first, so that the time they take is known: for a sixteenth of it, the choice "exact_rows"; none are
// kept if those are fewer than eight.
class RowsForError {
 public:
  struct Share {
    double of_cost = 0.01;
    std::size_t fewest = 16;
  };
  RowsForError(const matrix::LightingMatrix& matrix, const RunOptions& options, const RunClock& clock);
  // Writes the error of finished sums, all rows of which have an estimate. Nothing where no row that was read
  // has light.
  void state(std::span<const Rgb> sums, double columns_spent, const Share& share, Trace& trace);
  void state(std::span<const Rgb> sums, double columns_spent, Trace& trace) {
    state(sums, columns_spent, Share{}, trace);
  }
  std::size_t size() const { return known_.size(); }
  double row_seconds() const { return row_seconds_; }  // of one, where they were read first; else 0

 private:
  const matrix::LightingMatrix& matrix_;
  const RunOptions& options_;
  double row_seconds_ = 0;
  ExactRows known_;
};

}  // namespace lumirank::methods
