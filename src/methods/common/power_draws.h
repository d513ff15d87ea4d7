// Columns drawn with replacement in proportion to a weight, and scaled so that the sum is unbiased.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/random.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

struct DrawSettings {
  std::size_t count = 0;
  bool stratified =
      true;  // one draw in each of `count` equal parts of the running sum, instead of independent draws
  std::uint64_t seed = 1;
  Stage stage = Stage::method;
  std::uint64_t round = 0;  // rounds are independent of each other
};

// Draws among `candidates` in proportion to weights[candidate]; each draw is scaled by 1/(count·p), draws of
// one column are merged. Unbiased for Σ candidates if every candidate that is not zero has weight > 0. If all
// weights are 0 (or `weights` is empty) they count as equal.
std::vector<matrix::ScaledColumn> draw_columns(std::span<const matrix::Index> candidates,
                                               std::span<const float> weights, const DrawSettings& settings);

}  // namespace lumirank::methods
