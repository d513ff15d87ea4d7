#include "base/distribution.h"

#include <algorithm>
#include <cmath>

namespace lumirank {

Distribution1D::Distribution1D(std::span<const float> weights) : cdf_(weights.size() + 1, 0.0) {
  for (std::size_t i = 0; i < weights.size(); ++i) cdf_[i + 1] = cdf_[i] + static_cast<double>(weights[i]);
}

Distribution1D::Sample Distribution1D::sample(float u) const {
  const double target = static_cast<double>(u) * total();
  // The last bin whose left edge is not above the target; bins of zero width are stepped over.
  auto it = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, target);
  std::size_t i = static_cast<std::size_t>(it - cdf_.begin()) - 1;
  while (i > 0 && cdf_[i + 1] == cdf_[i]) --i;
  const double width = cdf_[i + 1] - cdf_[i];
  const double inside = width > 0 ? (target - cdf_[i]) / width : 0.0;
  return {i, static_cast<float>(width / total()), static_cast<float>(std::clamp(inside, 0.0, 0x1.fffffep-1))};
}

float Distribution1D::pmf(std::size_t i) const {
  return total() > 0 ? static_cast<float>((cdf_[i + 1] - cdf_[i]) / total()) : 0.0f;
}

}  // namespace lumirank
