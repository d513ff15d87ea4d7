// A distribution over columns, kept as its running sum alone.
#pragma once

#include <cstdint>
#include <span>

namespace lumirank::methods {

// Running sums in 32 bits: size + 1 numbers from 0 on. A column with any weight has at least one unit, and
// probabilities are those of the integers, so that what is drawn and what is divided by agree to the last bit
// however small a weight is.
class RunningSum {
 public:
  explicit RunningSum(std::span<const std::uint32_t> sums) : sums_(sums) {}

  // Writes the running sums of `weights` (finite, ≥ 0; fewer than 2^31); false if all are 0.
  static bool write(std::span<const float> weights, std::span<std::uint32_t> sums);

  bool empty() const { return sums_.back() == 0; }
  // The column of u in [0, 1); not empty.
  std::uint32_t draw(double u) const;
  float probability(std::uint32_t column) const {
    return static_cast<float>(sums_[column + 1] - sums_[column]) * inverse_total();
  }

 private:
  float inverse_total() const { return 1 / static_cast<float>(sums_.back()); }
  std::span<const std::uint32_t> sums_;
};

}  // namespace lumirank::methods
