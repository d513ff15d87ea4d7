#include "linalg/nested_levels.h"

#include <algorithm>
#include <limits>

#include "base/random.h"

namespace lumirank::linalg {

void NestedLevels::build(std::span<const Point> points, std::size_t spacing, std::uint64_t seed) {
  const std::size_t n = points.size();
  order_.resize(n);
  for (std::size_t k = 0; k < n; ++k) order_[k] = static_cast<std::uint32_t>(k);
  first_.assign(1, n);
  steps_.clear();
  // One of each stretch of `spacing` comes to the front; of what is left over then one of half as many, …
  std::size_t done = 0;
  for (std::size_t stretch = std::max<std::size_t>(spacing, 1); done < n; stretch = (stretch + 1) / 2) {
    // After a level one of `stretch` is done: as many again make it one of stretch / 2.
    const std::size_t of = done == 0 ? stretch : std::max<std::size_t>(2 * stretch - 1, 1);
    const std::size_t left = n - done, take = stretch == 1 ? left : (left + of - 1) / of;
    for (std::size_t k = 0; k < take; ++k) {
      const std::size_t begin = done + left * k / take, end = done + left * (k + 1) / take;
      const std::size_t chosen = begin + hash_ids(seed, Stage::method, done, k) % (end - begin);
      // Taken from its place; those between move up by one, so the others keep their order.
      std::rotate(order_.begin() + static_cast<std::ptrdiff_t>(done + k),
                  order_.begin() + static_cast<std::ptrdiff_t>(std::max(chosen, done + k)),
                  order_.begin() + static_cast<std::ptrdiff_t>(std::max(chosen, done + k)) + 1);
    }
    done += take;
    if (done == take)
      first_[0] = done;
    else
      first_.push_back(done);
  }
  coordinates_.resize(6 * n);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t d = 0; d < 6; ++d) coordinates_[d * n + k] = points[order_[k]][d];
  for (std::size_t l = 0; l + 1 < first_.size(); ++l)
    for (std::size_t k = first_[l]; k < first_[l + 1]; ++k) {
      Step step;
      step.point = order_[k];
      find_near(points, first_[l], step);
      steps_.push_back(step);
    }
}

void NestedLevels::find_near(std::span<const Point> points, std::size_t coarser, Step& step) const {
  constexpr std::size_t kBlock = 16;
  const std::size_t n = points.size();
  const Point& p = points[step.point];
  std::array<float, kNear> best;
  best.fill(std::numeric_limits<float>::infinity());
  step.near.fill(order_[0]);
  float distance[kBlock];
  for (std::size_t begin = 0; begin < coarser; begin += kBlock) {
    const std::size_t size = std::min(kBlock, coarser - begin);
    for (float& v : distance) v = 0;
    for (std::size_t d = 0; d < 6; ++d) {
      const float* x = coordinates_.data() + d * n + begin;
      for (std::size_t k = 0; k < size; ++k) distance[k] += (x[k] - p[d]) * (x[k] - p[d]);
    }
    for (std::size_t k = 0; k < size; ++k) {
      if (!(distance[k] < best[kNear - 1])) continue;
      std::size_t at = kNear - 1;
      for (; at > 0 && distance[k] < best[at - 1]; --at)
        best[at] = best[at - 1], step.near[at] = step.near[at - 1];
      best[at] = distance[k], step.near[at] = order_[begin + k];
    }
  }
  for (std::size_t k = std::min(coarser, kNear); k < kNear; ++k) step.near[k] = step.near[0];
}

}  // namespace lumirank::linalg
