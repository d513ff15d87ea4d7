// Sketch of a wide matrix for clustering its columns, gathered while its rows arrive: every column in a few
// dimensions, and every column's true norms. The matrix itself is never stored.
//
// Random projection (Vempala 2004; Hašan 2007, section 4): column ρ_j becomes Gᵀρ_j, G Gaussian with variance
// 1/r'. Row i of G is a function of (seed, i), so G is never stored either. Without projection the column is
// kept as it is.
//
// Coordinates are kept in 16 bits (Points): with r' = 50 a column costs 116 bytes, and the few rows that wait
// to be projected together at most 64 more (32 where there are millions). What this rounds off is some 10⁻⁴
// of a column's length, where projecting changes it by a tenth.
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

  struct Shape {
    std::size_t columns;
    std::size_t dimension;  // r'; or, without projection, the number of rows to make room for
    bool projected = true;  // false: every row is a dimension of its own, and memory grows with the rows
  };
  ColumnSketch(const Shape& shape, std::uint64_t seed);

  // Takes weight × row. values: columns × 3 channels, interleaved. The scalar entry is the 2-norm of the
  // triple. `id` keys the random numbers: the order in which rows arrive matters only by rounding. Returns
  // the sum of weight × scalar.
  double add_row(std::uint64_t id, float weight, std::span<const float> values);

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  // The columns as points, in `dimension` coordinates (without projection: those of rows yet to come are 0).
  // Valid until the next add_row, which makes room for waiting rows anew.
  Points points();
  // Norms over the rows seen: of scalars, and of one channel. Not projected.
  float norm(std::size_t j) const;
  float channel_norm(std::size_t j, std::size_t channel) const;
  bool is_zero(std::size_t j) const { return !(square(j) > 0); }

  std::size_t memory_bytes() const;

 private:
  void flush();
  void add_rows_as_dimensions(std::size_t begin, std::size_t end);
  void project(std::span<const float> gaussian, std::size_t begin, std::size_t end);
  void make_room(std::size_t rows);
  // Waiting row b of the columns [begin, end) as floats.
  void read_batch(std::size_t b, std::size_t begin, std::size_t end, float* out) const;
  float square(std::size_t j) const {
    return squares_[j * kChannels] + squares_[j * kChannels + 1] + squares_[j * kChannels + 2];
  }

  std::size_t columns_, dimension_, batch_rows_;
  bool projected_;
  std::uint64_t seed_;
  std::size_t rows_ = 0;
  std::vector<std::int16_t> units_;  // columns × dimension_, point-major
  std::vector<float> unit_;          // of each column
  std::vector<float> squares_;       // columns × 3 channels
  // Weighted scalars that wait for their GEMM: batch_rows_ × columns in 16 bits (short_float.h), with a scale
  // for each row and block of columns.
  std::vector<std::uint16_t> batch_;
  std::vector<float> batch_scale_;
  std::vector<std::uint64_t> batch_ids_;
};

}  // namespace lumirank::linalg
