// Rows kept as they are: from them follows, exactly, the error to expect there. Of rows that the clustering
// does not see that is the one at rows that were not read.
#pragma once

#include <span>
#include <vector>

#include "linalg/sampled_rows.h"
#include "methods/common/exact_rows.h"

namespace lumirank::methods {

class HeldOutRows {
 public:
  explicit HeldOutRows(const matrix::LightingMatrix& matrix) : entries_(matrix.columns()), known_(matrix) {}

  // Evaluates the row into `values` (one per column) and keeps its scalar entries, times the row's weight.
  void read(const SampledRow& row, std::span<Rgb> values);
  // The same for a row whose `values` are known.
  void add(const ExactRow& row, std::span<const Rgb> values);

  const linalg::SampledRows& entries() const { return entries_; }
  std::size_t rows() const { return known_.size(); }
  // What is exact there.
  const ExactRows& known() const { return known_; }
  // Σ over the rows of share × Σ_j scalar entry: the light of an image.
  double image_sum() const { return image_sum_; }

 private:
  void keep(const ExactRow& row, std::span<const Rgb> values);

  linalg::SampledRows entries_;
  ExactRows known_;
  double image_sum_ = 0;
};

}  // namespace lumirank::methods
