// Statistical verdicts for tests: how far a sample mean may lie from its expectation at a stated confidence.
#pragma once

#include <cmath>
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

}  // namespace lumirank::test
