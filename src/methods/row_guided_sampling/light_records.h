// Records: rows of the matrix that were read whole, and which of them a receiver is near.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "matrix/lighting_matrix.h"
#include "methods/row_guided_sampling/running_sum.h"

namespace lumirank::methods {

struct RecordSettings {
  std::size_t count = 256;
  std::uint64_t seed = 1;
};

// Rows to be records: half of them spread evenly over the picture, half where position and direction are
// farthest from all others', so that what is small in the picture has records as well. Distinct; fewer than
// asked for where there are fewer rows.
std::vector<matrix::Index> choose_records(const matrix::LightingMatrix& matrix,
                                          const RecordSettings& settings);

class RecordSpace;

// What a record keeps of an entry: r + g + b.
inline float record_brightness(Rgb x) { return std::max(0.0f, x.r + x.g + x.b); }

// Each record's entries as two distributions over the columns: with visibility and without; and the columns'
// power as a third for all. Memory: 8 bytes × records × columns.
class LightRecords {
 public:
  static constexpr std::size_t kNear = 4;
  static constexpr std::uint32_t kNone = 0xffffffffu;
  using Near = std::array<std::uint32_t, kNear>;

  // Reads the rows one after the other for as long as `go_on(how many were read)` says so. Those at which
  // nothing arrives, visible or not, are no record.
  LightRecords(const matrix::LightingMatrix& matrix, std::span<const matrix::Index> rows,
               const std::function<bool(std::size_t)>& go_on);
  LightRecords(LightRecords&&) noexcept;
  ~LightRecords();
  std::size_t size() const { return count_; }
  matrix::Cost cost() const { return cost_; }
  // Nearest first by place and direction; kNone where there are fewer.
  Near nearest(matrix::Index row) const;
  // 2r: of record r with visibility (may be empty), 2r + 1: without; kPower: by the columns' power.
  static constexpr std::uint32_t kPower = 0xffffffffu;
  RunningSum distribution(std::uint32_t number) const {
    if (number == kPower) return {power_.data(), columns_, 1};
    return {sums_.data() + (number & ~1u) * (columns_ + 1) + (number & 1), columns_, 2};
  }
  RunningSum lit(std::uint32_t record) const { return distribution(2 * record); }
  RunningSum unoccluded(std::uint32_t record) const { return distribution(2 * record + 1); }
  // Brightness of the whole row, by distribution.
  float brightness(std::uint32_t number) const { return totals_[number]; }

 private:
  std::size_t columns_, count_ = 0;
  std::unique_ptr<const RecordSpace> space_;
  std::array<std::vector<float>, 6> places_;  // of the records in it, by dimension
  std::vector<std::uint32_t> sums_, power_;
  std::vector<float> totals_;  // brightness of a record's row, by distribution
  matrix::Cost cost_;
};

}  // namespace lumirank::methods
