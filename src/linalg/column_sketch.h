// What a clustering needs to know of a wide matrix, gathered while its rows arrive: every column in a few
// dimensions, and every column's true norms. The matrix itself is never stored.
//
// Random projection (Vempala 2004; Hašan 2007, section 4): column ρ_j becomes Gᵀρ_j, G Gaussian with variance
// 1/r'. Row i of G is a function of (seed, i), so G is never stored either. Without projection the column is
// kept as it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "linalg/points.h"

namespace lumirank::linalg {

class ColumnSketch {
 public:
  static constexpr std::size_t kChannels = 3;

  // dimension: r' (> 0), or 0 to keep every row as a dimension of its own (memory then grows with the rows).
  ColumnSketch(std::size_t columns, std::size_t dimension, std::uint64_t seed);

  // Takes weight × row. values: columns × 3 channels, interleaved. The scalar entry is the 2-norm of the
  // triple. `id` keys the random numbers: the order in which rows arrive matters only by rounding.
  void add_row(std::uint64_t id, float weight, std::span<const float> values);

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  // The columns as points, in `dimension` (or, without projection, `rows`) coordinates. Valid until the next
  // add_row.
  Points points();
  // Norms over the rows seen: of scalars, and of one channel. Not projected.
  float norm(std::size_t j) const;
  float channel_norm(std::size_t j, std::size_t channel) const;
  bool is_zero(std::size_t j) const { return squares_[j * 4] == 0; }

 private:
  void flush();

  std::size_t columns_, dimension_, batch_rows_;
  bool projected_;
  std::uint64_t seed_;
  std::size_t rows_ = 0;
  std::vector<float> points_;   // columns × dimension_, point-major
  std::vector<float> squares_;  // columns × 4: scalar, then the three channels
  std::vector<float> batch_;    // batch_rows_ × columns: weighted scalars that wait for their GEMM
  std::vector<std::uint64_t> batch_ids_;
};

}  // namespace lumirank::linalg
