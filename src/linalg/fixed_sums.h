// Sums in an order that depends on nothing but the length: Eigen's start where memory is aligned, so that
// their last bits depend on where a vector lies.
#pragma once

#include <cstddef>

namespace lumirank::linalg {

// Σ a[i]·b[i], in sixteen interleaved partial sums.
inline float fixed_dot(const float* a, const float* b, std::size_t n) {
  constexpr std::size_t kLanes = 16;
  float lane[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) lane[l] += a[i + l] * b[i + l];
  for (std::size_t l = 0; i + l < n; ++l) lane[l] += a[i + l] * b[i + l];
  for (std::size_t width = kLanes / 2; width > 0; width /= 2)
    for (std::size_t l = 0; l < width; ++l) lane[l] += lane[l + width];
  return lane[0];
}

// Σ a[i], likewise.
inline float fixed_sum(const float* a, std::size_t n) {
  constexpr std::size_t kLanes = 16;
  float lane[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) lane[l] += a[i + l];
  for (std::size_t l = 0; i + l < n; ++l) lane[l] += a[i + l];
  for (std::size_t width = kLanes / 2; width > 0; width /= 2)
    for (std::size_t l = 0; l < width; ++l) lane[l] += lane[l + width];
  return lane[0];
}

}  // namespace lumirank::linalg
