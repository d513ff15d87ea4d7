// A draw in proportion to weights as a race: everyone's turn is an exponential deviate over its weight, and
// the least of a set is the one drawn. Whoever wins in a set wins in each of its subsets that has it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"

namespace lumirank::methods {

inline float race_turn(std::uint64_t bits, float weight) {
  if (!(weight > 0)) return std::numeric_limits<float>::infinity();
  return -std::log(std::max(unit_float(bits), 0x1p-25f)) / weight;
}

}  // namespace lumirank::methods
