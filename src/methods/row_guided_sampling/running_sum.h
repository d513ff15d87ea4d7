// A distribution over columns, kept as its running sum alone.
#pragma once

#include <algorithm>
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
  // Draws from sums of one size, side by side: each waits for memory at every step, and all of them together
  // no longer than one.
  class Search;
  // Of `total`.
  std::uint32_t units(std::uint32_t column) const { return at(column + 1) - at(column); }
  float probability(std::uint32_t column) const {
    return static_cast<float>(units(column)) / static_cast<float>(total());
  }

 private:
  // Below the total, whatever rounding makes of it.
  std::uint32_t unit_of(double u) const {
    return std::min(static_cast<std::uint32_t>(u * static_cast<double>(total())), total() - 1);
  }
  std::uint32_t at(std::size_t k) const { return sums_[k * stride_]; }
  const std::uint32_t* sums_;
  std::size_t size_, stride_;
};

class RunningSum::Search {
 public:
  Search() = default;
  Search(const RunningSum& sum, double u)
      : sums_(sum.sums_), size_(sum.size_), stride_(sum.stride_), unit_(sum.unit_of(u)) {}
  // The last column whose sum begins at its unit or below.
  static void finish(std::span<Search> searches);
  std::uint32_t column() const { return first_; }

 private:
  const std::uint32_t* sums_ = nullptr;
  std::size_t size_ = 0, stride_ = 1;
  std::uint32_t unit_ = 0, first_ = 0;
};

}  // namespace lumirank::methods
