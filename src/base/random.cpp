#include "base/random.h"

#include <cmath>

namespace lumirank {

double Rng::next_gaussian() {
  // Box-Muller; 1 - u keeps the logarithm's argument away from 0.
  const double u = 1.0 - next_double();
  const double v = next_double();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * 3.14159265358979323846 * v);
}

}  // namespace lumirank
