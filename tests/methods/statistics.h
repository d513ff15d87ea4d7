// Judging unbiasedness: the mean of many runs against the truth.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "base/random.h"
#include "base/rgb.h"

namespace lumirank::methods::test {

// Largest |t| of `projections` random combinations of rows (Gaussian weights) and of the plain total, over
// independent runs. The combinations are fixed before the runs, so each t is a test of E[estimate] = truth
// with runs − 1 degrees of freedom.
class UnbiasednessTest {
 public:
  UnbiasednessTest(std::vector<Rgb> truth, std::size_t projections)
      : truth_(std::move(truth)), projections_(projections) {
    sum_.assign(projections + 1, 0.0);
    squares_.assign(projections + 1, 0.0);
  }

  void add(std::span<const Rgb> sums) {
    for (std::size_t p = 0; p <= projections_; ++p) {
      Rng rng(99, Stage::test, 100, p);
      double v = 0;
      for (std::size_t i = 0; i < truth_.size(); ++i)
        for (int c = 0; c < 3; ++c) {
          const double weight = p == 0 ? 1.0 : rng.next_gaussian();
          v += weight * (static_cast<double>(sums[i][c]) - static_cast<double>(truth_[i][c]));
        }
      sum_[p] += v;
      squares_[p] += v * v;
    }
    ++runs_;
  }

  double largest_t() const {
    double largest = 0;
    const double n = static_cast<double>(runs_);
    for (std::size_t p = 0; p <= projections_; ++p) {
      const double mean = sum_[p] / n, variance = (squares_[p] - n * mean * mean) / (n - 1);
      largest = std::max(largest, std::abs(mean) / std::sqrt(variance / n));
    }
    return largest;
  }

 private:
  std::vector<Rgb> truth_;
  std::size_t projections_;
  std::vector<double> sum_, squares_;
  std::size_t runs_ = 0;
};

}  // namespace lumirank::methods::test
