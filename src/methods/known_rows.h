// Rows that were read whole. There the sum over all columns is known, and for nothing also how far it is from
// the sum over infinitely many: what the two halves of the columns disagree by, and what clamping took away.
// A sample of such rows tells the error of an image and its parts.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "matrix/lighting_matrix.h"
#include "methods/method.h"

namespace lumirank::methods {

struct SampledRow {
  matrix::Index row;
  float weight;  // √(block size × number of blocks / rows): makes Σ|weight × entry|² unbiased for the mean
                 // square of a column
};

struct KnownRow {
  SampledRow from;
  double share;         // of an image's light: weight² × the row's weight in the image
  Rgb sum;              // of all columns
  Rgb half_difference;  // |sum over half 1 − sum over half 2| of the columns, per channel
  double clamped;       // r + g + b that clamping took away
};

// A relative L1 error, and the half width of its 95 % interval: by the delete-a-group jackknife over 16
// groups of rows. The interval knows of the choice of rows, not of that of the lights.
struct ErrorPart {
  double value = 0, half_width = 0;
};

// Relative to what infinitely many unclamped columns are estimated to add up to.
struct ErrorParts {
  ErrorPart sampling;  // estimate against the sum of all columns
  ErrorPart lights;    // their number: the sum of all against the limit, without clamping
  ErrorPart clamping;  // a loss, so it adds in full
  // √(sampling² + lights²) + clamping: the first two are independent of each other and of mean 0.
  ErrorPart total() const;
};

class KnownRows {
 public:
  explicit KnownRows(const matrix::LightingMatrix& matrix) : matrix_(&matrix) {}

  // Evaluates the row into `values` (one per column) and keeps what the errors need.
  const KnownRow& read(const SampledRow& row, std::span<Rgb> values);
  void append(const KnownRows& others);

  std::span<const KnownRow> rows() const { return rows_; }
  std::size_t size() const { return rows_.size(); }

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
  std::vector<KnownRow> rows_;
};

// error.estimate, error.sampling, error.lights, error.clamping and their half widths; or the last two alone.
void write_error(const ErrorParts& parts, Trace& trace);
void write_error_of_lights(const ErrorParts& parts, Trace& trace);

// What may be left to sampling for the whole error to be `target`. Where the other parts leave too little
// (less than a quarter of it), no number of columns helps: then half of the target, which adds little to
// them.
double target_for_sampling(double target, double lights, double clamping);

// `count` stratified rows, read.
KnownRows read_rows(const matrix::LightingMatrix& matrix, std::size_t count, std::uint64_t seed);
// For methods that read no rows: looks at some afterwards and writes their error. 64 rows if an error is
// asked for, otherwise as many as cost 1 % of the entries already spent, or none if those are fewer than 16.
void look_at_rows(const matrix::LightingMatrix& matrix, const RunOptions& options, std::span<const Rgb> sums,
                  double columns_spent, Trace& trace);

}  // namespace lumirank::methods
