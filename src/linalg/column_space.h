// The space that the columns of a matrix span, as far as it is known, and columns completed in it from few of
// their rows (Krishnamurthy and Singh 2014, "On the power of adaptivity in matrix completion and
// approximation"; Huo et al. 2016, section 5.1.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

// A matrix has `rows` rows of `width` numbers each (channels), which are known or unknown together. A column
// is rows·width numbers, row after row.
class ColumnSpace {
 public:
  // Empties it.
  void begin(std::size_t rows, std::size_t width);
  std::size_t rank() const { return rank_; }
  std::size_t length() const { return length_; }

  // Adds what of the column lies outside as one more direction, if that is more than rounding (Gram and
  // Schmidt twice). `coordinates` gets rank() numbers, with which combine() gives the column.
  void add(std::span<const float> column, std::vector<float>& coordinates);

  // From now on columns are known in these rows.
  void sample(std::span<const std::uint32_t> rows);
  std::size_t sampled() const { return rows_.size(); }

  struct Fit {
    // Root of the sum of squares over all sampled values: of the column itself; of what is left beside the
    // space; of the same where each row is foretold by the others alone (the leverages of its values
    // inverted), which is what the fit is worth in rows that are not sampled.
    double size = 0, residual = 0, left_out = 0;
  };
  // Least squares by the QR factors of the sampled part of the basis, never by normal equations. `values`: of
  // the sampled rows; `coordinates` gets rank() numbers. Directions that the sampled rows hardly see, by
  // themselves or beside those before them, get 0.
  Fit fit(std::span<const float> values, std::vector<float>& coordinates);

  // out = Σ coordinate · direction; fewer coordinates than directions: the others are 0.
  void combine(std::span<const float> coordinates, std::span<float> out) const;

 private:
  void factor();
  void invert_leverages();

  std::size_t width_ = 1, length_ = 0, rank_ = 0;
  std::vector<float> basis_;         // direction after direction
  std::vector<std::uint32_t> rows_;  // that are sampled
  // QR factors of the basis in these rows, of its first `factored_` directions.
  std::size_t factored_ = 0;
  std::vector<float> q_;                // direction after direction
  std::vector<std::vector<float>> r_;   // column d: of directions 0 … d
  std::vector<std::uint8_t> seen_;      // by direction: not left out of the fit
  std::vector<float> leverage_, open_;  // by sampled row, width × width: H, and (I − H)⁻¹
};

}  // namespace lumirank::linalg
