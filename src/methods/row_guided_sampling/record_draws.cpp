#include "methods/row_guided_sampling/record_draws.h"

#include <algorithm>

#include "base/random.h"

namespace lumirank::methods {

namespace {

// What goes to rows with visibility and without; the others are drawn by power.
constexpr float kLitShare = 0.6f, kUnoccludedShare = 0.25f;
// Records see what a receiver sees, or nearly: what none of them sees is looked for more seldom, not never.
constexpr float kLeastVisible = 0.05f;

}  // namespace

RecordMixture::RecordMixture(const LightRecords& records, matrix::Index row) : records_(records) {
  std::size_t lit = 0;
  for (const std::uint32_t record : records.nearest(row)) {
    if (record == LightRecords::kNone) continue;
    near_[near_count_++] = record;
    if (!records.lit(record).empty()) part_[count_++] = 2 * record, ++lit;
  }
  for (std::size_t k = 0; k < near_count_; ++k) part_[count_++] = 2 * near_[k] + 1;
  float left = 1;
  for (std::size_t k = 0; k < count_; ++k) {
    share_[k] =
        k < lit ? kLitShare / static_cast<float>(lit) : kUnoccludedShare / static_cast<float>(near_count_);
    left -= share_[k];
  }
  part_[count_] = LightRecords::kPower, share_[count_++] = left;
}

GuidedColumn RecordMixture::draw(double u) const {
  std::size_t k = 0;
  for (; k + 1 < count_ && u >= static_cast<double>(share_[k]); ++k) u -= static_cast<double>(share_[k]);
  const double within = std::min(u / static_cast<double>(share_[k]), 0x1.fffffffffffffp-1);
  const matrix::Index column = records_.distribution(part_[k]).draw(within);
  return {column, probability_of(column), visibility_of(column)};
}

float RecordMixture::probability_of(matrix::Index column) const {
  float sum = 0;
  for (std::size_t k = 0; k < count_; ++k)
    sum += share_[k] * records_.distribution(part_[k]).probability(column);
  return sum;
}

float RecordMixture::visibility_of(matrix::Index column) const {
  float lit = 0, whole = 0;
  for (std::size_t k = 0; k < near_count_; ++k) {
    const LightRecords::Brightness b = records_.brightness(near_[k], column);
    lit += b.lit, whole += b.unoccluded;
  }
  return whole > 0 ? std::clamp(lit / whole, kLeastVisible, 1.0f) : 1.0f;
}

double spread_fraction(std::uint64_t index, std::uint64_t seed) {
  // Digits from the lowest on, each flipped by a hash of those before it.
  std::uint64_t before = 1;
  double fraction = 0, weight = 0.5;
  for (int digit = 0; digit < 24; ++digit, weight *= 0.5) {
    const std::uint64_t bit = index >> digit & 1;
    fraction += weight * static_cast<double>(bit ^ (mix64(seed ^ before) & 1));
    before = before << 1 | bit;
  }
  return fraction + weight * 2 * unit_double(mix64(seed ^ ~index));
}

}  // namespace lumirank::methods
