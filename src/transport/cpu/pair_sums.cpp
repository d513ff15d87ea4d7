// What happens to the visible entries of a block: sums and energies.
#include <algorithm>

#include "transport/cpu/pair_block.h"

namespace lumirank::transport {
namespace {

double energy(const Lane3& e, int lane) {
  return static_cast<double>(e.x[lane]) + static_cast<double>(e.y[lane]) + static_cast<double>(e.z[lane]);
}

}  // namespace

double PairBlock::visible_energy() const {
  // Lane by lane: a block has too few groups for floats to lose anything.
  const Lane zero{};
  Lane3 sums{zero, zero, zero};
  for (std::size_t g = 0; g < groups_; ++g)
    if (lanes_.visible[g] != 0)
      sums = sums + select(mask_from_bits(lanes_.visible[g]), e(g), Lane3{zero, zero, zero});
  double sum = 0;
  for (int k = 0; k < static_cast<int>(kLanes); ++k) sum += energy(sums, k);
  return sum;
}

double PairBlock::removed_energy() const {
  double sum = 0;
  for (std::size_t g = 0; g < groups_; ++g)
    for (std::uint32_t b = lanes_.clamped[g] & lanes_.visible[g]; b != 0; b &= b - 1) {
      const int k = __builtin_ctz(b);
      sum += static_cast<double>(excess_[g][k]) * energy(e(g), k);
    }
  return sum;
}

void PairBlock::load_sums(std::span<const Rgb> sums) {
  sums_.assign(std::max(sums_.size(), 3 * groups_), Lane{});
  const std::uint32_t* items = context_.rows->plan.item.data() + tile_.first_slot;
  for (std::size_t place = 0; place < 16 * groups_; ++place) {
    if (items[place] == kNoItem) continue;
    const Rgb sum = sums[items[place]];
    for (std::size_t c = 0; c < 3; ++c) sums_[3 * (place / 16) + c][place % 16] = sum[static_cast<int>(c)];
  }
}

double PairBlock::add_to_sums(Rgb scale) {
  const Lane zero{};
  const Lane3 s = splat(scale);
  double removed = 0;
  for (std::size_t g = 0; g < groups_; ++g) {
    if (lanes_.visible[g] == 0) continue;
    const LaneMask lit = mask_from_bits(lanes_.visible[g]);
    const Lane3 added = select(lit, s * e(g), Lane3{zero, zero, zero});
    sums_[3 * g] += added.x, sums_[3 * g + 1] += added.y, sums_[3 * g + 2] += added.z;
    for (std::uint32_t b = lanes_.clamped[g] & lanes_.visible[g]; b != 0; b &= b - 1) {
      const int k = __builtin_ctz(b);
      removed += static_cast<double>(excess_[g][k]) * energy(added, k);
    }
  }
  return removed;
}

double PairBlock::store_sums(std::span<Rgb> sums) const {
  const std::uint32_t* items = context_.rows->plan.item.data() + tile_.first_slot;
  double added = 0;
  for (std::size_t place = 0; place < 16 * groups_; ++place) {
    if (items[place] == kNoItem) continue;
    Rgb& to = sums[items[place]];
    for (std::size_t c = 0; c < 3; ++c) {
      const float now = sums_[3 * (place / 16) + c][place % 16];
      added += static_cast<double>(now) - static_cast<double>(to[static_cast<int>(c)]);
      to[static_cast<int>(c)] = now;
    }
  }
  return added;
}

void PairBlock::add_shares(Rgb scale, std::span<const float> shares, std::span<const std::uint32_t> of,
                           std::span<float> sums) const {
  const Lane3 s = splat(scale);
  for (std::size_t g = 0; g < groups_; ++g) {
    if (lanes_.visible[g] == 0) continue;
    float share[kLanes];
    for (std::size_t k = 0; k < kLanes; ++k) share[k] = shares[of[16 * g + k]];
    const Lane3 added = select(mask_from_bits(lanes_.visible[g]), s * load(share) * e(g), Lane3{});
    float* const to = &sums[48 * g];
    store(to, load(to) + added.x);
    store(to + 16, load(to + 16) + added.y);
    store(to + 32, load(to + 32) + added.z);
  }
}

matrix::Cost finish(PairBlock& block, matrix::Part part, std::size_t pairs) {
  matrix::Cost cost;
  cost.entries = pairs;
  cost.culled = pairs - block.survivors();
  if (part == matrix::Part::unoccluded) {
    block.skip_visibility();
    return cost;
  }
  block.trace(part == matrix::Part::value);
  cost.rays = block.survivors();
  if (part == matrix::Part::value) {
    cost.energy = block.visible_energy();
    cost.clamped = block.removed_energy();
  }
  return cost;
}

}  // namespace lumirank::transport
