// Brute force at a sample of the receivers, for renders whose whole matrix is out of reach: exact row sums
// there, and the error of an estimate with its confidence interval.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "base/sinks.h"
#include "film/metrics.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::rendering {

class SampledTruth {
 public:
  // Sums of `count` rows over all columns; the rows are drawn one from each of `count` equal ranges, which in
  // the receivers' order are pieces of the image. `weights`: what the film makes of a row (one per row).
  SampledTruth(const matrix::LightingMatrix& matrix, std::span<const Rgb> weights, std::size_t count,
               std::uint64_t seed, const Sinks& sinks);

  std::size_t count() const { return rows_.size(); }

  struct Error {
    film::ErrorMetrics metrics;  // over receivers instead of pixels
    double l1_half_width = 0,
           l2_half_width = 0;  // of the 95 % intervals, by the delete-a-group jackknife over 32 groups
  };
  Error error_of(std::span<const Rgb> sums) const;

 private:
  std::vector<matrix::Index> rows_;
  std::vector<Rgb> weights_, truth_;
};

}  // namespace lumirank::rendering
