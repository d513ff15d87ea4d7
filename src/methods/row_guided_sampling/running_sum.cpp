#include "methods/row_guided_sampling/running_sum.h"

#include <algorithm>

namespace lumirank::methods {

bool RunningSum::write(std::span<const float> weights, std::span<std::uint32_t> sums) {
  double total = 0;
  std::size_t lit = 0;
  for (const float w : weights) total += static_cast<double>(w), lit += w > 0 ? 1 : 0;
  sums[0] = 0;
  if (!(total > 0)) {
    std::fill(sums.begin(), sums.end(), 0u);
    return false;
  }
  // One unit for each, and the other units by weight: running sums of both, rounded down, grow by at least 1.
  const double scale = (4294967295.0 - static_cast<double>(lit) - 1) / total;
  double sum = 0;
  std::uint32_t units = 0;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    if (weights[j] > 0) sum += static_cast<double>(weights[j]), ++units;
    sums[j + 1] = static_cast<std::uint32_t>(sum * scale) + units;
  }
  return true;
}

std::uint32_t RunningSum::draw(double u) const {
  const double target = u * static_cast<double>(sums_.back());
  // Below the total, whatever rounding makes of it.
  const auto unit = std::min(static_cast<std::uint32_t>(target), sums_.back() - 1);
  return static_cast<std::uint32_t>(std::upper_bound(sums_.begin() + 1, sums_.end(), unit) - sums_.begin() -
                                    1);
}

}  // namespace lumirank::methods
