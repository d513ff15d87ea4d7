// A distribution over columns, kept as its running sum alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lumirank::methods {

// Running sums in 32 bits: size + 1 numbers from 0 on. A column with any weight has at least one unit, and
// probabilities are those of the integers, so that what is drawn and what is divided by agree to the last bit
// however small a weight is.
class RunningSum {
 public:
  // `sums`: size + 1 numbers, each `stride` after the one before, so that sums which are asked together lie
  // together.
  RunningSum(const std::uint32_t* sums, std::size_t size, std::size_t stride)
      : sums_(sums), size_(size), stride_(stride) {}

  // Writes the running sums of `weights` (finite, ≥ 0; fewer than 2^31); false if all are 0.
  static bool write(std::span<const float> weights, std::uint32_t* sums, std::size_t stride);

  std::uint32_t total() const { return at(size_); }
  bool empty() const { return total() == 0; }
  // The column of u in [0, 1); not empty.
  std::uint32_t draw(double u) const;
  // Of `total`.
  std::uint32_t units(std::uint32_t column) const { return at(column + 1) - at(column); }
  float probability(std::uint32_t column) const {
    return static_cast<float>(units(column)) / static_cast<float>(total());
  }

 private:
  std::uint32_t at(std::size_t k) const { return sums_[k * stride_]; }
  const std::uint32_t* sums_;
  std::size_t size_, stride_;
};

}  // namespace lumirank::methods
