// Many rows of a wide matrix of numbers ≥ 0 in 16 bits (short_float.h), row after row: for who reads some
// whole rows at a time. Within 2⁻¹² of an entry, or 0 below 2⁻³¹ of the row's largest. (SampledRows keeps few
// rows, so that all that is known of one column lies together.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

class ShortRows {
 public:
  ShortRows(std::size_t rows, std::size_t columns)
      : columns_(columns), entries_(rows * columns), scale_(rows, 1.0f) {}

  std::size_t rows() const { return scale_.size(); }
  std::size_t columns() const { return columns_; }
  // One number per column.
  void set(std::size_t row, std::span<const float> values);
  // Column k of every row becomes what column order[k] was; columns that are not in `order` are dropped.
  void permute(std::span<const std::uint32_t> order);
  // out[k] = entry (row, begin + k).
  void read(std::size_t row, std::size_t begin, std::span<float> out) const;

  std::size_t memory_bytes() const {
    return entries_.capacity() * sizeof(std::uint16_t) + scale_.capacity() * sizeof(float);
  }

 private:
  std::size_t columns_;
  std::vector<std::uint16_t> entries_;
  std::vector<float> scale_;
};

}  // namespace lumirank::linalg
