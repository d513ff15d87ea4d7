// Reduced matrix, learned from rows: a sketch of every column, and what the sum should be at the rows that
// were read.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linalg/column_sketch.h"
#include "methods/common/exact_rows.h"
#include "methods/common/held_out_rows.h"
#include "methods/common/row_sampler.h"

namespace lumirank::methods {

// E|x| of a standard normal deviate, √(2/π).
inline constexpr double kMeanOfNormal = 0.79788456080286536;

// What a row counts for where columns are told apart.
enum class RowWeights {
  light,  // as in the paper: all alike, so that the bright ones decide
  eye,    // by 1 / (its light + a tenth of the mean): eyes see what an error is of the light around it
};

class ReducedMatrix {
 public:
  ReducedMatrix(const matrix::LightingMatrix& matrix, const linalg::ColumnSketch::Shape& shape,
                std::uint64_t seed, RowWeights weights = RowWeights::light)
      : sketch_(shape, seed), known_(matrix), by_eye_(weights == RowWeights::eye), kept_(matrix) {}

  // Evaluates the row into `values` (one per column) and takes it in. The random numbers of the projection
  // are keyed by the row.
  void read(const SampledRow& row, std::span<Rgb> values);

  linalg::ColumnSketch& sketch() {
    settle();
    return sketch_;
  }
  const linalg::ColumnSketch& sketch() const { return sketch_; }
  std::size_t rows() const { return known_.size(); }
  // What is exact there.
  const ExactRows& known() const { return known_; }
  // Σ over the rows of (weight × Σ_j scalar entry)²: ‖Σ_R‖² of the paper. The weight is that of the row as a
  // sample times what it counts for.
  double squared_sum() const { return squared_sum_; }
  // Σ over the rows of share × Σ_j scalar entry: the light of an image.
  double image_sum() const { return image_sum_; }
  // Some of the rows as they are, where rows count by eye: what the sketch knows of errors is relative to the
  // light around them, and an image's error is not. Else none.
  const HeldOutRows& kept() const { return kept_; }
  // Relative L1 error of an image over its relative 2-norm error, if errors at all rows are normal deviates
  // of one size: E|·| is √(2/π) of that.
  double l1_over_l2() const;

 private:
  struct Waiting {
    ExactRow row;
    std::vector<Rgb> values;
  };
  void take(const ExactRow& row, std::span<const Rgb> values);
  // Takes in what has waited: by eye, the first rows do until there are enough of them for a mean.
  void settle();

  linalg::ColumnSketch sketch_;
  ExactRows known_;
  bool by_eye_;
  HeldOutRows kept_;
  double mean_ = 0;  // light of a row; 0: not known yet
  std::vector<Waiting> waiting_;
  std::size_t taken_ = 0;
  double squared_sum_ = 0, image_sum_ = 0;
};

}  // namespace lumirank::methods
