// Some rows of a wide matrix of numbers ≥ 0, kept as they are but in 16 bits (short_float.h): 2 bytes per
// entry, within 2⁻¹² of it or nearly 0. Point-major in blocks of 16 rows, so that all that is known of one
// column lies together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

class SampledRows {
 public:
  static constexpr std::size_t kBlockRows = 16;

  explicit SampledRows(std::size_t columns) : columns_(columns) {}

  // One number per column.
  void add(std::span<const float> row);

  std::size_t size() const { return rows_; }
  std::size_t columns() const { return columns_; }
  std::size_t blocks() const { return blocks_.size(); }
  // Rows [16·block, …) of column j. out: kBlockRows floats; rows that are not there are 0.
  void read(std::size_t block, std::size_t j, float* out) const;

  std::size_t memory_bytes() const;

 private:
  static constexpr std::size_t kStretch = 2048;  // columns with one scale per row

  struct Block {
    std::vector<std::uint16_t> entries;  // columns × kBlockRows
    std::vector<float> scale;            // stretches × kBlockRows
  };
  std::size_t columns_, rows_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace lumirank::linalg
