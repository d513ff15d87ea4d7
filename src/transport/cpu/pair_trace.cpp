// The shadow rays of a block's survivors, 16 to a packet in the order of the pairs.
#include <algorithm>
#include <cstring>

#include "base/random.h"
#include "transport/cpu/pair_block.h"
#include "world/world.h"

namespace lumirank::transport {

std::uint32_t PairBlock::row_slot(std::uint32_t place) const {
  return shape_ == BlockShape::column ? tile_.first_slot + place
         : shape_ == BlockShape::row  ? partner_.slot
                                      : list_.rows[place];
}
std::uint32_t PairBlock::column_slot(std::uint32_t place) const {
  return shape_ == BlockShape::row      ? tile_.first_slot + place
         : shape_ == BlockShape::column ? partner_.slot
                                        : list_.columns[place];
}

bool PairBlock::to_infinity(std::uint32_t slot) const {
  return context_.columns->plan.kind_of(slot) == kColumnDirectional;
}

// Where a surface shines through, the side from which a ray starts depends on its direction.
void PairBlock::orient_endpoints(const std::uint32_t* places, int count, Lane3& origin, Lane3& target) const {
  const auto &row_turns = context_.rows->two_sided, &column_turns = context_.columns->two_sided;
  for (int k = 0; k < count; ++k) {
    const std::uint32_t row = row_slot(places[k]), column = column_slot(places[k]);
    const bool turn_row = !row_turns.empty() && row_turns[row];
    const bool turn_column = !column_turns.empty() && column_turns[column];
    if (!turn_row && !turn_column) continue;
    const Vec3f p = context_.rows->get(row, &RowGroup::p), y = context_.columns->get(column, &ColumnGroup::p);
    const Vec3f w = to_infinity(column) ? Vec3f{target.x[k], target.y[k], target.z[k]} : y - p;
    if (turn_row)
      set_lane(origin, k, world::World::offset_origin(p, context_.rows->get(row, &RowGroup::ng), w));
    if (turn_column)
      set_lane(target, k,
               world::World::offset_origin(y, context_.columns->get(column, &ColumnGroup::ng), -w));
  }
}

void PairBlock::fill(geometry::ShadowPacket& packet, std::size_t first, int count) const {
  const std::uint32_t* places = &survivors_.places[first];
  Lane3 origin, target;
  if (shape_ == BlockShape::column) {
    origin = {load(&survivors_.end_x[first]), load(&survivors_.end_y[first]), load(&survivors_.end_z[first])};
    target = splat(context_.columns->get(partner_.slot, &ColumnGroup::target));
  } else if (shape_ == BlockShape::row) {
    origin = splat(context_.rows->get(partner_.slot, &RowGroup::origin));
    target = {load(&survivors_.end_x[first]), load(&survivors_.end_y[first]), load(&survivors_.end_z[first])};
  } else {
    for (int k = 0; k < 16; ++k) {
      const std::uint32_t place = places[k < count ? k : 0];
      set_lane(origin, k, context_.rows->get(list_.rows[place], &RowGroup::origin));
      set_lane(target, k, context_.columns->get(list_.columns[place], &ColumnGroup::target));
    }
  }
  if (context_.has_two_sided) orient_endpoints(places, count, origin, target);
  LaneMask far{};
  if (context_.has_directional) {
    if (shape_ == BlockShape::column) {
      far = to_infinity(partner_.slot) ? ~far : far;
    } else {
      for (int k = 0; k < count; ++k) far[k] = to_infinity(column_slot(places[k])) ? -1 : 0;
    }
  }
  const Lane3 along = select(far, target, target - origin);
  store(packet.ox, origin.x), store(packet.oy, origin.y), store(packet.oz, origin.z);
  store(packet.dx, along.x), store(packet.dy, along.y), store(packet.dz, along.z);
  store(packet.t_far, select(far, splat(kInfinity), splat(1)));
  const LaneMask valid = kLaneNumbers < count;
  std::memcpy(packet.valid, &valid, sizeof valid);
  if (!context_.has_cutouts) return;
  // The keys only have to differ from pair to pair: whoever decides by them hashes them with the surface's
  // ids.
  packet.seed = context_.pair_seed;
  if (shape_ == BlockShape::column) {
    std::copy_n(&survivors_.end_key[first], 16, packet.from);
    std::fill_n(packet.to, 16, context_.columns->key[partner_.slot]);
  } else if (shape_ == BlockShape::row) {
    std::fill_n(packet.from, 16, context_.rows->key[partner_.slot]);
    std::copy_n(&survivors_.end_key[first], 16, packet.to);
  } else {
    for (int k = 0; k < count; ++k) {
      packet.from[k] = context_.rows->key[list_.rows[places[k]]];
      packet.to[k] = context_.columns->key[list_.columns[places[k]]];
    }
  }
}

void PairBlock::note_transmittance(const geometry::ShadowPacket& packet, std::size_t first, int count) {
  Rgb through[16];
  context_.rays->transmittance16(packet, through);
  for (int k = 0; k < count; ++k)
    if (through[k] != Rgb(1))
      survivors_.attenuations.push_back({survivors_.places[first + static_cast<std::size_t>(k)], through[k]});
}

void PairBlock::apply_transmittance() {
  shade();
  for (const Attenuation& a : survivors_.attenuations)
    for (std::uint32_t c = 0; c < 3; ++c)
      e_[3 * (a.place / 16) + c][a.place % 16] *= a.through[static_cast<int>(c)];
}

void PairBlock::trace(bool values) {
  require(Stage::pairs, "trace");
  stage_ = Stage::evaluated;
  values_wanted_ = values;
  survivors_.attenuations.clear();
  geometry::ShadowPacket packet;
  const std::size_t packets = (survivors_.count + 15) / 16;
  for (std::size_t p = 0; p < packets; ++p) {
    const int count = static_cast<int>(std::min<std::size_t>(16, survivors_.count - 16 * p));
    fill(packet, 16 * p, count);
    survivors_.packet_bits[p] = context_.rays->visible16(packet);
    if (context_.has_attenuating && values && survivors_.packet_bits[p] != 0) {
      // What is hidden need not be attenuated.
      for (int k = 0; k < count; ++k)
        if (!(survivors_.packet_bits[p] >> k & 1)) packet.valid[k] = 0;
      note_transmittance(packet, 16 * p, count);
    }
  }
  survivors_.packet_bits[packets] = 0;
  std::size_t at = 0;  // bit of the next survivor
  for (std::size_t g = 0; g < groups_; ++g) {
    const std::uint32_t alive_bits = lanes_.alive[g];
    if (alive_bits == 0) {
      lanes_.visible[g] = 0;
      continue;
    }
    const std::uint32_t two = survivors_.packet_bits[at / 16] |
                              static_cast<std::uint32_t>(survivors_.packet_bits[at / 16 + 1]) << 16;
    lanes_.visible[g] = static_cast<std::uint16_t>(deposit_bits(two >> (at % 16), alive_bits));
    at += static_cast<std::size_t>(__builtin_popcount(alive_bits));
  }
  apply_transmittance();
}

void PairBlock::skip_visibility() {
  require(Stage::pairs, "skip_visibility");
  stage_ = Stage::evaluated;
  values_wanted_ = true;
  survivors_.attenuations.clear();
  std::copy_n(lanes_.alive.begin(), groups_, lanes_.visible.begin());
  if (context_.has_attenuating) {
    geometry::ShadowPacket packet;
    for (std::size_t p = 0; 16 * p < survivors_.count; ++p) {
      const int count = static_cast<int>(std::min<std::size_t>(16, survivors_.count - 16 * p));
      fill(packet, 16 * p, count);
      note_transmittance(packet, 16 * p, count);
    }
  }
  apply_transmittance();
}

}  // namespace lumirank::transport
