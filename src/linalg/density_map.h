// Map of where the errors of a separation are dense: there the matrix is of high rank, and its entries are
// better evaluated (Huo et al. 2015, section 6.2).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

// A 7 × 7 Gaussian (σ = 1.4) over flags that lie column after column. At the borders the weights inside add
// up to 1. Keeps its buffers.
class DensityMap {
 public:
  static constexpr std::size_t kReach = 3;

  void build(std::span<const std::uint8_t> flags, std::size_t rows, std::size_t columns);
  std::span<const float> density() const { return density_; }  // 0 … 1, same layout

 private:
  std::vector<float> along_, line_, density_;
};

}  // namespace lumirank::linalg
