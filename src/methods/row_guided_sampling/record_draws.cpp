#include "methods/row_guided_sampling/record_draws.h"

#include <algorithm>

#include "base/random.h"

namespace lumirank::methods {

namespace {

// What goes to rows with visibility, without, and to bounds; the others are drawn by power.
constexpr float kLitShare = 0.55f, kUnoccludedShare = 0.15f, kBoundedShare = 0.2f;
// Among the distributions' numbers.
constexpr std::uint32_t kBounded = LightRecords::kPower - 1;
// Records see what a receiver sees, or nearly: what none of them sees is looked for more seldom, not never.
constexpr float kLeastVisible = 0.05f;

}  // namespace

RecordMixture::RecordMixture(const LightRecords& records, const BoundedDistribution& bounded,
                             matrix::Index row)
    : records_(records), bounded_(bounded), power_(records.distribution(LightRecords::kPower)) {
  const LightRecords::Near nearest = records.nearest(row);
  std::size_t known = 0, lit = 0;
  for (const std::uint32_t record : nearest)
    if (record != LightRecords::kNone) ++known, lit += records.lit(record).empty() ? 0 : 1;
  double end = 0;
  const auto piece = [&](std::uint32_t number, float share) {
    end += static_cast<double>(share);
    pieces_[piece_count_++] = {end, number};
  };
  for (const std::uint32_t record : nearest) {
    if (record == LightRecords::kNone) continue;
    NearRecord near{records.lit(record), records.unoccluded(record), 0, 0, 0, 0};
    if (!near.lit.empty()) {
      const float share = kLitShare / static_cast<float>(lit);
      piece(2 * record, share);
      near.lit_share = share / static_cast<float>(near.lit.total());
      near.lit_light = records.brightness(2 * record) / static_cast<float>(near.lit.total());
    }
    const float share = kUnoccludedShare / static_cast<float>(known);
    piece(2 * record + 1, share);
    near.unoccluded_share = share / static_cast<float>(near.unoccluded.total());
    near.unoccluded_light = records.brightness(2 * record + 1) / static_cast<float>(near.unoccluded.total());
    near_[near_count_++] = near;
  }
  if (!bounded.empty()) piece(kBounded, bounded_share_ = kBoundedShare);
  power_share_ = static_cast<float>(1 - end) / static_cast<float>(power_.total());
  pieces_[piece_count_++] = {1, LightRecords::kPower};
}

void RecordMixture::draw(double offset, std::span<GuidedColumn> drawn) const {
  constexpr std::size_t kTogether = 16;
  std::array<RunningSum::Search, kTogether> searches;
  std::array<std::size_t, kTogether> searched;
  std::size_t k = 0;
  for (std::size_t first = 0; first < drawn.size(); first += kTogether) {
    const std::size_t end = std::min(first + kTogether, drawn.size());
    std::size_t count = 0;
    for (std::size_t m = first; m < end; ++m) {
      const double u = (static_cast<double>(m) + offset) / static_cast<double>(drawn.size());
      while (k + 1 < piece_count_ && u >= pieces_[k].end) ++k;
      const double begin = k > 0 ? pieces_[k - 1].end : 0;
      const double within = std::min((u - begin) / (pieces_[k].end - begin), 0x1.fffffffffffffp-1);
      const std::uint32_t number = pieces_[k].distribution;
      if (number == kBounded) {
        drawn[m].column = bounded_.draw(within);
      } else {
        searched[count] = m;
        searches[count++] = RunningSum::Search(records_.distribution(number), within);
      }
    }
    RunningSum::Search::finish(std::span(searches).first(count));
    for (std::size_t s = 0; s < count; ++s) drawn[searched[s]].column = searches[s].column();
    for (std::size_t m = first; m < end; ++m) drawn[m] = guided(drawn[m].column);
  }
}

GuidedColumn RecordMixture::guided(std::uint32_t column) const {
  float probability = power_share_ * static_cast<float>(power_.units(column)), lit = 0, whole = 0;
  if (bounded_share_ > 0) probability += bounded_share_ * bounded_.probability(column);
  for (std::size_t n = 0; n < near_count_; ++n) {
    const NearRecord& near = *near_[n];
    const auto l = static_cast<float>(near.lit.units(column));
    const auto e = static_cast<float>(near.unoccluded.units(column));
    probability += near.lit_share * l + near.unoccluded_share * e;
    lit += near.lit_light * l, whole += near.unoccluded_light * e;
  }
  return {column, probability, whole > 0 ? std::clamp(lit / whole, kLeastVisible, 1.0f) : 1.0f};
}

double spread_fraction(std::uint64_t index, std::uint64_t seed) {
  // Digits from the lowest on, each flipped by a hash of those before it, and of the block: with the same
  // flips everywhere every second column of the picture would draw from the same half.
  constexpr int kDigits = 6;
  const std::uint64_t of_block = mix64(seed ^ mix64(index >> kDigits));
  std::uint64_t before = 1;
  double fraction = 0, weight = 0.5;
  for (int digit = 0; digit < kDigits; ++digit, weight *= 0.5) {
    const std::uint64_t bit = index >> digit & 1;
    fraction += weight * static_cast<double>(bit ^ (mix64(of_block ^ before) & 1));
    before = before << 1 | bit;
  }
  return fraction + weight * 2 * unit_double(mix64(seed ^ ~index));
}

}  // namespace lumirank::methods
