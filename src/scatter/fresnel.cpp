#include "scatter/fresnel.h"

namespace lumirank::scatter {
namespace {

// n > 1, not close to 1 (the terms cancel there).
double walsh(double n) {
  const double n2 = n * n, n4 = n2 * n2;
  const double plus = n2 + 1, minus = n2 - 1;
  return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
         n2 * minus * minus / (plus * plus * plus) * std::log((n - 1) / (n + 1)) -
         2 * n * n2 * (n2 + 2 * n - 1) / (plus * (n4 - 1)) +
         8 * n4 * (n4 + 1) / (plus * (n4 - 1) * (n4 - 1)) * std::log(n);
}

double from_outside(double n) {
  // Closer to 1 the closed form loses digits; the reflectance there is under 1e-4 and nearly linear in n - 1.
  constexpr double near_one = 1.0001;
  return n >= near_one ? walsh(n) : walsh(near_one) * (n - 1) / (near_one - 1);
}

}  // namespace

float fresnel_diffuse_reflectance(float eta) {
  if (eta == 1) return 0;
  if (eta > 1) return static_cast<float>(from_outside(eta));
  // What leaves the denser side is what would enter it, times the ratio of the phase spaces: eta².
  return static_cast<float>(1 - eta * eta * (1 - from_outside(1.0 / eta)));
}

}  // namespace lumirank::scatter
