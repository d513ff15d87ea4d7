// Choice of the rows to read (2007, section 4, "Row analysis": blocks of the image, one row in each).
//
// Ours: the rows are put in the order of a Hilbert curve over the image and cut into as many stretches as
// rows are wanted. A stretch is a connected block of the image, and all blocks hold equally many receivers (±
// 1), also where a pixel has several and where part of the image has none; every row is drawn with the known
// probability 1 / (size of its block).
#pragma once

#include <cstdint>
#include <vector>

#include "matrix/lighting_matrix.h"
#include "methods/common/exact_rows.h"

namespace lumirank::methods {

class RowSampler {
 public:
  // Without pixel features the blocks are stretches of the index.
  RowSampler(const matrix::LightingMatrix& matrix, std::uint64_t seed);

  // min(count, rows) distinct rows, one in each of as many blocks. Rounds are independent of each other.
  std::vector<SampledRow> stratified(std::size_t count, std::uint64_t round = 0) const;
  // Draws `count` more rows, never one that this function gave before. At every time, blocks 1/2, 1/4, 1/8, …
  // of the curve have equal shares of all rows given so far (± 1): a scrambled van der Corput sequence (Owen
  // 1995).
  std::vector<SampledRow> next(std::size_t count);
  // As next(), but half of them in proportion to `density` (one number ≥ 0 per row, averaged over blocks of
  // the image), for rows where something is known to be wrong. Weights make up for it: 1/√(rows ×
  // probability).
  std::vector<SampledRow> next_by_density(std::size_t count, std::span<const float> density);

 private:
  std::uint64_t seed_;
  std::vector<matrix::Index> order_;  // rows along the curve
  std::vector<bool> given_;
  std::size_t given_count_ = 0;
  std::uint32_t sequence_ = 0;
};

}  // namespace lumirank::methods
