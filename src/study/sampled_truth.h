// Brute force at a sample of the receivers, for renders whose whole matrix is out of reach: exact row sums
// there, and the error of an estimate with its confidence interval.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "base/sinks.h"
#include "image/metrics.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::study {

class SampledTruth {
 public:
  struct Film {
    std::span<const Rgb> weights;            // what the film makes of a row (one per row)
    std::span<const std::uint32_t> samples;  // film sample of each row
    std::size_t per_pixel;                   // film samples
  };
  // Sums over all columns of the rows of whole pixels, about `count` rows in all; the pixels are drawn one
  // from each of as many equal ranges of the rows, which in the receivers' order are pieces of the image.
  // Whole pixels, because some methods estimate nothing smaller.
  SampledTruth(const matrix::LightingMatrix& matrix, const Film& film, std::size_t count, std::uint64_t seed,
               const Sinks& sinks);

  std::size_t rows() const { return rows_.size(); }
  std::size_t pixels() const { return truth_.size(); }

  struct Error {
    PictureError metrics;  // over the sampled pixels; without FLIP (NaN)
    double l1_half_width = 0,
           l2_half_width = 0;  // of the 95 % intervals, by the delete-a-group jackknife over 32 groups
  };
  Error error_of(std::span<const Rgb> sums) const;

 private:
  std::vector<matrix::Index> rows_;
  std::vector<Rgb> weights_;          // of rows_
  std::vector<std::uint32_t> first_;  // of each pixel's rows, and one past the end
  std::vector<Rgb> truth_;            // by pixel
};

}  // namespace lumirank::study
