#include "base/distribution.h"

#include <algorithm>
#include <cmath>

namespace lumirank {

Distribution1D::Distribution1D(std::span<const float> weights, std::size_t bins_at_once)
    : cdf_(weights.size() + 1, 0.0) {
  for (std::size_t i = 0; i < weights.size(); ++i) cdf_[i + 1] = cdf_[i] + static_cast<double>(weights[i]);
  total_ = cdf_.back();
  if (weights.size() < kGuidedFrom) return;
  const std::size_t parts = weights.size() / bins_at_once;
  guide_.resize(parts + 1);
  std::size_t i = 0;
  for (std::size_t k = 0; k < guide_.size(); ++k) {
    const double target = total() * static_cast<double>(k) / static_cast<double>(parts);
    while (i + 1 < weights.size() && cdf_[i + 1] <= target) ++i;
    guide_[k] = static_cast<std::uint32_t>(i);
  }
}

// Of the guide, that `u` lies in; exact, the product having fewer bits than a double.
std::size_t Distribution1D::part(float u) const {
  const std::size_t parts = guide_.size() - 1;
  return std::min(static_cast<std::size_t>(static_cast<double>(u) * static_cast<double>(parts)), parts - 1);
}

void Distribution1D::fetch(float u) const {
  if (!guide_.empty()) prefetch(&guide_[part(u)]);
}

void Distribution1D::fetch_bins(float u) const {
  if (guide_.empty()) return;
  // Where many lie between them the search begins in the middle.
  const std::size_t k = part(u), first = guide_[k] + 1, last = guide_[k + 1] + 1;
  for (const std::size_t i : {first - 1, (first + last) / 2, last}) prefetch(&cdf_[i]);
}

Distribution1D::Sample Distribution1D::sample(float u) const {
  const double target = static_cast<double>(u) * total();
  // The last bin whose left edge is not above the target; bins of zero width are stepped over.
  auto first = cdf_.begin() + 1, last = cdf_.end() - 1;
  if (!guide_.empty()) {
    const std::size_t k = part(u);
    last = first + guide_[k + 1];
    first += guide_[k];
  }
  const auto it = std::upper_bound(first, last, target);
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
