// The estimate of a run, made of several passes: each pass is unbiased by itself, and they are averaged by
// the inverse of the variance that was expected of them before a column was rendered, so that the average is
// unbiased too.
#pragma once

#include <span>
#include <vector>

#include "base/rgb.h"

namespace lumirank::methods {

class Blend {
 public:
  // expected_error: relative, > 0 or 0 for an exact pass.
  void add(std::span<const Rgb> sums, double expected_error);
  // What add() would give, leaving this as it is.
  std::vector<Rgb> with(std::span<const Rgb> sums, double expected_error) const;

  // The weight that such a pass would get beside those before it: 1 for the first.
  double share_of(double expected_error) const;

  bool empty() const { return precision_ == 0; }
  std::vector<Rgb>& sums() { return sums_; }
  const std::vector<Rgb>& sums() const { return sums_; }
  double expected_error() const;
  // Squared difference, per row, of the last pass from the blend before it; empty before the second pass.
  std::span<const float> disagreement() const { return disagreement_; }

 private:
  std::vector<Rgb> sums_;
  std::vector<float> disagreement_;
  double precision_ = 0;  // Σ 1/error²
};

}  // namespace lumirank::methods
