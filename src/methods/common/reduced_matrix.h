// Reduced matrix, learned from rows: a sketch of every column, and what the sum should be at the rows that
// were read.
#pragma once

#include <cstdint>
#include <span>

#include "linalg/column_sketch.h"
#include "methods/common/exact_rows.h"
#include "methods/common/row_sampler.h"

namespace lumirank::methods {

// E|x| of a standard normal deviate, √(2/π).
inline constexpr double kMeanOfNormal = 0.79788456080286536;

class ReducedMatrix {
 public:
  ReducedMatrix(const matrix::LightingMatrix& matrix, const linalg::ColumnSketch::Shape& shape,
                std::uint64_t seed)
      : sketch_(shape, seed), known_(matrix) {}

  // Evaluates the row into `values` (one per column) and takes it in. The random numbers of the projection
  // are keyed by the row.
  void read(const SampledRow& row, std::span<Rgb> values);

  linalg::ColumnSketch& sketch() { return sketch_; }
  const linalg::ColumnSketch& sketch() const { return sketch_; }
  std::size_t rows() const { return known_.size(); }
  // What is exact there.
  const ExactRows& known() const { return known_; }
  // Σ over the rows of (weight × Σ_j scalar entry)²: ‖Σ_R‖² of the paper.
  double squared_sum() const { return squared_sum_; }
  // Σ over the rows of share × Σ_j scalar entry: the light of an image.
  double image_sum() const { return image_sum_; }
  // Relative L1 error of an image over its relative 2-norm error, if errors at all rows are normal deviates
  // of one size: E|·| is √(2/π) of that.
  double l1_over_l2() const;

 private:
  linalg::ColumnSketch sketch_;
  ExactRows known_;
  double squared_sum_ = 0, image_sum_ = 0;
};

}  // namespace lumirank::methods
