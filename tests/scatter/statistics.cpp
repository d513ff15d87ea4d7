#include "scatter/statistics.h"

#include <cmath>

namespace lumirank::scatter {
namespace {

// Regularized incomplete gamma functions: the series of the lower one, Lentz's continued fraction of the
// upper one.
double lower_series(double a, double x) {
  double term = 1 / a, sum = term;
  for (int n = 1; n < 10000; ++n) {
    term *= x / (a + n);
    sum += term;
    if (term < sum * 1e-15) break;
  }
  return sum * std::exp(-x + a * std::log(x) - std::lgamma(a));
}

double upper_fraction(double a, double x) {
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int i = 1; i < 10000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return h * std::exp(-x + a * std::log(x) - std::lgamma(a));
}

}  // namespace

double chi_square_tail(double x, int degrees) {
  if (x <= 0) return 1;
  const double a = 0.5 * degrees, h = 0.5 * x;
  return h < a + 1 ? 1 - lower_series(a, h) : upper_fraction(a, h);
}

}  // namespace lumirank::scatter
