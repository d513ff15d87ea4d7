#include "methods/common/power_draws.h"

#include <algorithm>

namespace lumirank::methods {

std::vector<matrix::ScaledColumn> draw_columns(std::span<const matrix::Index> candidates,
                                               std::span<const float> weights, const DrawSettings& settings) {
  std::vector<matrix::ScaledColumn> drawn;
  if (candidates.empty() || settings.count == 0) return drawn;
  std::vector<double> cdf(candidates.size() + 1, 0.0);
  const auto fill = [&](bool equal) {
    for (std::size_t k = 0; k < candidates.size(); ++k)
      cdf[k + 1] = cdf[k] + (equal ? 1.0 : static_cast<double>(weights[candidates[k]]));
  };
  fill(weights.empty());
  if (cdf.back() == 0) fill(true);

  Rng rng(settings.seed, settings.stage, settings.round);
  const double count = static_cast<double>(settings.count);
  std::vector<std::size_t> picks;
  picks.reserve(settings.count);
  for (std::size_t k = 0; k < settings.count; ++k) {
    const double u =
        settings.stratified ? (static_cast<double>(k) + rng.next_double()) / count : rng.next_double();
    // The first right edge above the target: never a bin of zero width.
    auto it = std::upper_bound(cdf.begin() + 1, cdf.end(), u * cdf.back());
    if (it == cdf.end()) it = std::lower_bound(cdf.begin() + 1, cdf.end(), cdf.back());
    picks.push_back(static_cast<std::size_t>(it - cdf.begin()) - 1);
  }
  std::sort(picks.begin(), picks.end());
  for (std::size_t k = 0; k < picks.size();) {
    std::size_t end = k;
    while (end < picks.size() && picks[end] == picks[k]) ++end;
    const double p = (cdf[picks[k] + 1] - cdf[picks[k]]) / cdf.back();
    drawn.push_back(
        {candidates[picks[k]], Rgb(static_cast<float>(static_cast<double>(end - k) / (count * p)))});
    k = end;
  }
  // Sorted draws are stratified by index; a random order makes every prefix a fair sample of them.
  for (std::size_t k = drawn.size(); k > 1; --k) std::swap(drawn[k - 1], drawn[rng.next_below(k)]);
  return drawn;
}

}  // namespace lumirank::methods
