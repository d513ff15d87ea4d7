// The mean of pictures that are independent of each other, and how noisy it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "film/pixel_lattice.h"
#include "image/image.h"

namespace lumirank::pipeline {

// In each pixel, pictures are added to one of two halves by turns: halves of equal weight differ by twice the
// noise of the mean.
class PictureMean {
 public:
  // All of one size. `weight`: 1 over what is known of the picture's variance, in any unit; above 0.
  // `pixels`: those of a film that the picture has; its own corner is (0, 0).
  void add(const image::Image& picture, double weight = 1, film::PixelLattice pixels = {});
  std::size_t count() const { return count_; }
  // Of all of them, by their weights; empty without any.
  image::Image mean() const;
  // Relative L1 of the mean's noise, Σ|first half − second half| / (2 Σ mean), over pixels that have both,
  // and channels; where halves are of different weight, in proportion. 0 without any.
  double noise() const;
  // The halves' difference, scaled so that it is twice the noise of the mean; 0 in pixels with less than two.
  // Empty with fewer than two pictures.
  image::Image difference() const;

 private:
  image::Image sum_[2];
  std::vector<float> weight_[2];    // by pixel
  std::vector<std::uint8_t> next_;  // half, by pixel
  std::size_t count_ = 0;
};

}  // namespace lumirank::pipeline
