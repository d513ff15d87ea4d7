// Statistical verdicts for tests: how far a sample mean may lie from its expectation, and counts from the
// expected ones, at a stated confidence.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace lumirank::test {

struct Mean {
  double mean = 0, standard_error = 0;
  std::size_t count = 0;
};

inline Mean mean_of(std::span<const double> values) {
  Mean m;
  m.count = values.size();
  for (double v : values) m.mean += v;
  m.mean /= static_cast<double>(m.count);
  double squares = 0;
  for (double v : values) squares += (v - m.mean) * (v - m.mean);
  m.standard_error = std::sqrt(squares / static_cast<double>(m.count - 1) / static_cast<double>(m.count));
  return m;
}

// The same without keeping the values; for those that are not small differences of large numbers.
class RunningMean {
 public:
  void add(double x) { ++count_, sum_ += x, squares_ += x * x; }
  double mean() const { return sum_ / static_cast<double>(count_); }
  double standard_error() const {
    const double m = mean();
    return std::sqrt(std::max(0.0, squares_ / static_cast<double>(count_) - m * m) /
                     static_cast<double>(count_ - 1));
  }

 private:
  std::int64_t count_ = 0;
  double sum_ = 0, squares_ = 0;
};

// Two-sided quantile of the normal distribution for a false alarm in `alpha` of all runs, shared by `tests`
// tests (Bonferroni). Bisection of erfc: exact enough and free of tables.
inline double normal_quantile(double alpha, std::size_t tests = 1) {
  const double p = alpha / static_cast<double>(tests);
  double lo = 0, hi = 40;
  for (int k = 0; k < 200; ++k) {
    const double mid = (lo + hi) / 2;
    (std::erfc(mid / std::sqrt(2.0)) > p ? lo : hi) = mid;
  }
  return hi;
}

// The same for Student's t with `freedom` degrees of freedom: Hill's asymptotic expansion (1970), better than
// 1 % for freedom ≥ 7.
inline double student_quantile(double alpha, std::size_t tests, std::size_t freedom) {
  const double z = normal_quantile(alpha, tests), n = static_cast<double>(freedom);
  const double g1 = (z * z * z + z) / 4;
  const double g2 = (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / 96;
  const double g3 = (3 * std::pow(z, 7) + 19 * std::pow(z, 5) + 17 * z * z * z - 15 * z) / 384;
  return z + g1 / n + g2 / (n * n) + g3 / (n * n * n);
}

// The mean agrees with `expected` at a confidence of 1 - 10⁻⁶ two-sided (a mean of many bounded samples is
// close to normal). `systematic` is a known relative error of the numbers themselves, 10⁻⁵ for sums of
// floats.
inline void expect_mean(const RunningMean& m, double expected, double systematic = 1e-5) {
  EXPECT_NEAR(m.mean(), expected,
              normal_quantile(1e-6) * m.standard_error() + systematic * std::abs(expected));
}

// P(X ≥ x) for X chi-square distributed with `degrees` degrees of freedom: the regularized upper incomplete
// gamma function, by the series of the lower one or Lentz's continued fraction.
inline double chi_square_tail(double x, int degrees) {
  if (x <= 0) return 1;
  const double a = 0.5 * degrees, h = 0.5 * x, scale = std::exp(-h + a * std::log(h) - std::lgamma(a));
  if (h < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && term >= sum * 1e-15; ++n) {
      term *= h / (a + n);
      sum += term;
    }
    return 1 - sum * scale;
  }
  double b = h + 1 - a, c = 1e300, d = 1 / b, fraction = d, factor = 0;
  for (int n = 1; n < 10000 && std::abs(factor - 1) >= 1e-15; ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    d = 1 / (numerator * d + b);
    c = b + numerator / c;
    factor = d * c;
    fraction *= factor;
  }
  return fraction * scale;
}

// Pearson's test of counts. Bins in which fewer than 10 are expected are pooled into one, which counts if 10
// are expected in it.
class ChiSquareTest {
 public:
  void add(double seen, double expected) {
    if (expected < kMinExpected)
      pooled_seen_ += seen, pooled_expected_ += expected;
    else
      sum_ += square_over(seen, expected), ++bins_;
  }
  double pooled_seen() const { return pooled_seen_; }
  double pooled_expected() const { return pooled_expected_; }
  bool pool_counts() const { return pooled_expected_ >= kMinExpected; }
  int bins() const { return bins_ + (pool_counts() ? 1 : 0); }
  double statistic() const {
    return sum_ + (pool_counts() ? square_over(pooled_seen_, pooled_expected_) : 0.0);
  }
  // Probability of so much or more if the expectations are right, `lost` degrees of freedom being taken by
  // the total or by parameters.
  double tail(int lost = 1) const { return chi_square_tail(statistic(), bins() - lost); }

 private:
  static constexpr double kMinExpected = 10;
  static double square_over(double seen, double expected) {
    return (seen - expected) * (seen - expected) / expected;
  }

  double sum_ = 0, pooled_seen_ = 0, pooled_expected_ = 0;
  int bins_ = 0;
};

}  // namespace lumirank::test
