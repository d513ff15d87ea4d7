#include "methods/row_guided_sampling/running_sum.h"

#include <algorithm>

namespace lumirank::methods {

bool RunningSum::write(std::span<const float> weights, std::uint32_t* sums, std::size_t stride) {
  double total = 0;
  std::size_t lit = 0;
  for (const float w : weights) total += static_cast<double>(w), lit += w > 0 ? 1 : 0;
  sums[0] = 0;
  if (!(total > 0)) {
    for (std::size_t j = 0; j <= weights.size(); ++j) sums[j * stride] = 0;
    return false;
  }
  // One unit for each, and the other units by weight: running sums of both, rounded down, grow by at least 1.
  const double scale = (4294967295.0 - static_cast<double>(lit) - 1) / total;
  double sum = 0;
  std::uint32_t units = 0;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    if (weights[j] > 0) sum += static_cast<double>(weights[j]), ++units;
    sums[(j + 1) * stride] = static_cast<std::uint32_t>(sum * scale) + units;
  }
  return true;
}

std::uint32_t RunningSum::draw(double u) const {
  Search search(*this, u);
  Search::finish({&search, 1});
  return search.column();
}

void RunningSum::Search::finish(std::span<Search> searches) {
  if (searches.empty()) return;
  for (std::size_t left = searches.front().size_; left > 1;) {
    const std::size_t half = left / 2;
    for (Search& s : searches) {
      const auto middle = static_cast<std::uint32_t>(s.first_ + half);
      s.first_ = s.sums_[middle * s.stride_] <= s.unit_ ? middle : s.first_;
    }
    left -= half;
  }
}

}  // namespace lumirank::methods
