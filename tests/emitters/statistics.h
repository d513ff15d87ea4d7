// Statistical judgements for sampled means.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace lumirank::test {

// Mean and standard error of independent samples.
struct Mean {
  std::int64_t n = 0;
  double sum = 0, squares = 0;
  void add(double x) { ++n, sum += x, squares += x * x; }
  double mean() const { return sum / static_cast<double>(n); }
  double error() const {
    const double m = mean();
    return std::sqrt(std::max(0.0, squares / static_cast<double>(n) - m * m) / static_cast<double>(n - 1));
  }
};

// The mean agrees with `expected` at a confidence of 1 - 10⁻⁶ two-sided (4.9 standard errors of a normal
// deviate, which a mean of many bounded samples is close to). `systematic` is a known relative error of the
// numbers themselves, 10⁻⁵ for sums of floats.
inline void expect_mean(const Mean& m, double expected, double systematic = 1e-5) {
  EXPECT_NEAR(m.mean(), expected, 4.9 * m.error() + systematic * std::abs(expected));
}

// Upper quantile of chi-square with k degrees of freedom that is passed with probability 10⁻⁵ (Wilson and
// Hilferty's approximation; 4.265 is the normal quantile).
inline double chi_square_limit(double k) {
  const double h = 2 / (9 * k), t = 1 - h + 4.265 * std::sqrt(h);
  return k * t * t * t;
}

}  // namespace lumirank::test
