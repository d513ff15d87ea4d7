// What has been learned from rows: a sketch of every column, and what the sum should be at the rows that were
// read.
#pragma once

#include <cstdint>
#include <vector>

#include "linalg/column_sketch.h"
#include "methods/row_column/row_sampler.h"

namespace lumirank::methods {

class Exploration {
 public:
  Exploration(const matrix::LightingMatrix& matrix, std::size_t projection, std::uint64_t seed)
      : matrix_(matrix), sketch_(matrix.columns(), projection, seed), buffer_(matrix.columns()) {}

  // Evaluates the row and takes it in. The random numbers of the projection are keyed by the row.
  void read(const SampledRow& row);

  linalg::ColumnSketch& sketch() { return sketch_; }
  const linalg::ColumnSketch& sketch() const { return sketch_; }
  std::size_t rows() const { return rows_.size(); }
  // Σ over the rows of (weight × Σ_j scalar entry)²: ‖Σ_R‖² of the paper.
  double squared_sum() const { return squared_sum_; }
  // Relative 2-norm error of `sums` (all rows, RGB) on the rows that were read, where the truth is known.
  double measured_error(std::span<const Rgb> sums) const;

 private:
  const matrix::LightingMatrix& matrix_;
  linalg::ColumnSketch sketch_;
  std::vector<Rgb> buffer_;
  std::vector<SampledRow> rows_;
  std::vector<Rgb> exact_;  // sums of the rows that were read
  double squared_sum_ = 0;
};

}  // namespace lumirank::methods
