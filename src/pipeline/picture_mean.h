// The mean of pictures that are independent of each other, and how noisy it is.
#pragma once

#include <cstddef>

#include "image/image.h"

namespace lumirank::pipeline {

// Pictures are added to one of two halves by turns: halves of equal weight differ by twice the noise of the
// mean.
class PictureMean {
 public:
  // All of one size. `weight`: 1 over what is known of the picture's variance, in any unit; above 0.
  void add(const image::Image& picture, double weight = 1);
  std::size_t count() const { return count_[0] + count_[1]; }
  // Of all of them, by their weights; empty without any.
  image::Image mean() const;
  // Relative L1 of the mean's noise, Σ|first half − second half| / (2 Σ mean), over pixels and channels;
  // where halves are of different weight, in proportion. 0 with fewer than two pictures.
  double noise() const;
  // The halves' difference, scaled so that it is twice the noise of the mean. Empty with fewer than two.
  image::Image difference() const;

 private:
  image::Image sum_[2];
  std::size_t count_[2] = {0, 0};
  double weight_[2] = {0, 0};
};

}  // namespace lumirank::pipeline
