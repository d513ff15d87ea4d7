// Judging unbiasedness: the mean of many runs against the truth.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "base/random.h"
#include "base/rgb.h"
#include "support/sanitizers.h"
#include "support/statistics.h"

namespace lumirank::methods::test {

// Runs of a statistical test: a fifth of them under sanitizers, which look for other faults in the same code.
// Limits must follow from the number of runs, so that the confidence is the same; what they can see is then
// more than twice as large (√5 in standard errors, and a wider t).
constexpr std::size_t runs(std::size_t all) { return lumirank::test::kSanitized ? all / 5 : all; }

// Largest |t| of `projections` random combinations of rows (Gaussian weights) and of the plain total, over
// independent runs. The combinations are fixed before the runs, so each t is a test of E[estimate] = truth
// with runs − 1 degrees of freedom.
class UnbiasednessTest {
 public:
  UnbiasednessTest(std::vector<Rgb> truth, std::size_t projections)
      : truth_(std::move(truth)), projections_(projections) {
    for (std::size_t p = 0; p <= projections; ++p) {
      Rng rng(99, Stage::test, 100, p);
      for (std::size_t k = 0; k < 3 * truth_.size(); ++k)
        weights_.push_back(p == 0 ? 1.0 : rng.next_gaussian());
    }
    sum_.assign(projections + 1, 0.0);
    squares_.assign(projections + 1, 0.0);
  }

  void add(std::span<const Rgb> sums) {
    for (std::size_t p = 0; p <= projections_; ++p) {
      const double* weight = weights_.data() + p * 3 * truth_.size();
      double v = 0;
      for (std::size_t i = 0; i < truth_.size(); ++i)
        for (int c = 0; c < 3; ++c)
          v += *weight++ * (static_cast<double>(sums[i][c]) - static_cast<double>(truth_[i][c]));
      sum_[p] += v;
      squares_[p] += v * v;
    }
    ++runs_;
  }

  // What max_t() stays below with a probability of 1 − alpha if the runs are unbiased.
  double limit(double alpha = 0.001) const {
    return lumirank::test::student_quantile(alpha, projections_ + 1, runs_ - 1);
  }
  double max_t() const {
    double max_t_value = 0;
    const double n = static_cast<double>(runs_);
    for (std::size_t p = 0; p <= projections_; ++p) {
      const double mean = sum_[p] / n, variance = (squares_[p] - n * mean * mean) / (n - 1);
      max_t_value = std::max(max_t_value, std::abs(mean) / std::sqrt(variance / n));
    }
    return max_t_value;
  }

 private:
  std::vector<Rgb> truth_;
  std::size_t projections_;
  std::vector<double> weights_, sum_, squares_;
  std::size_t runs_ = 0;
};

}  // namespace lumirank::methods::test
