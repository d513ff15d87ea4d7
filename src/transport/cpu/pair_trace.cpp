// The shadow rays of a block's survivors, 16 to a packet in the order of the pairs.
#include <algorithm>
#include <cstring>

#include "base/random.h"
#include "transport/cpu/pair_block.h"
#include "world/world.h"

namespace lumirank::transport {
namespace {

// Field `field` of a slot, in all lanes.
template <typename Store>
Lane3 repeat(const Store& from, std::uint32_t slot, int field) {
  return splat(read3(from.at(slot) + field));
}

void set(Lane3& v, int lane, Vec3f value) { v.x[lane] = value.x, v.y[lane] = value.y, v.z[lane] = value.z; }

}  // namespace

std::uint32_t PairBlock::row_slot(std::uint32_t place) const {
  return shape_ == BlockShape::column ? first_slot_ + place
         : shape_ == BlockShape::row  ? fixed_slot_
                                      : row_list_[place];
}
std::uint32_t PairBlock::column_slot(std::uint32_t place) const {
  return shape_ == BlockShape::row      ? first_slot_ + place
         : shape_ == BlockShape::column ? fixed_slot_
                                        : column_list_[place];
}

bool PairBlock::to_infinity(std::uint32_t slot) const {
  return context_.columns->plan.kind_of(slot) == kColumnDirectional;
}

// Where a surface shines through, the side from which a ray starts depends on its direction.
void PairBlock::turn_ends(const std::uint32_t* places, int count, Lane3& origin, Lane3& target) const {
  const auto &row_turns = context_.rows->two_sided, &column_turns = context_.columns->two_sided;
  for (int k = 0; k < count; ++k) {
    const std::uint32_t row = row_slot(places[k]), column = column_slot(places[k]);
    const bool turn_row = !row_turns.empty() && row_turns[row];
    const bool turn_column = !column_turns.empty() && column_turns[column];
    if (!turn_row && !turn_column) continue;
    const float *r = context_.rows->at(row), *c = context_.columns->at(column);
    const Vec3f p = read3(r + kPositionField), y = read3(c + kPositionField);
    const Vec3f w = to_infinity(column) ? Vec3f{target.x[k], target.y[k], target.z[k]} : y - p;
    if (turn_row) set(origin, k, world::World::offset_origin(p, read3(r + kGeometricNormalField), w));
    if (turn_column) set(target, k, world::World::offset_origin(y, read3(c + kGeometricNormalField), -w));
  }
}

void PairBlock::fill(geometry::ShadowPacket& packet, std::size_t first, int count) const {
  const std::uint32_t* places = &places_[first];
  Lane3 origin, target;
  if (shape_ == BlockShape::column) {
    origin = {load(&end_x_[first]), load(&end_y_[first]), load(&end_z_[first])};
    target = repeat(*context_.columns, fixed_slot_, kTargetField);
  } else if (shape_ == BlockShape::row) {
    origin = repeat(*context_.rows, fixed_slot_, kOriginField);
    target = {load(&end_x_[first]), load(&end_y_[first]), load(&end_z_[first])};
  } else {
    for (int k = 0; k < 16; ++k) {
      const std::uint32_t place = places[k < count ? k : 0];
      set(origin, k, read3(context_.rows->at(row_list_[place]) + kOriginField));
      set(target, k, read3(context_.columns->at(column_list_[place]) + kTargetField));
    }
  }
  if (context_.has_two_sided) turn_ends(places, count, origin, target);
  LaneMask far{};
  if (context_.has_directional) {
    if (shape_ == BlockShape::column) {
      far = to_infinity(fixed_slot_) ? ~far : far;
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
    std::copy_n(&end_key_[first], 16, packet.from);
    std::fill_n(packet.to, 16, context_.columns->key[fixed_slot_]);
  } else if (shape_ == BlockShape::row) {
    std::fill_n(packet.from, 16, context_.rows->key[fixed_slot_]);
    std::copy_n(&end_key_[first], 16, packet.to);
  } else {
    for (int k = 0; k < count; ++k) {
      packet.from[k] = context_.rows->key[row_list_[places[k]]];
      packet.to[k] = context_.columns->key[column_list_[places[k]]];
    }
  }
}

void PairBlock::note_transmittance(const geometry::ShadowPacket& packet, std::size_t first, int count) {
  Rgb through[16];
  context_.rays->transmittance16(packet, through);
  for (int k = 0; k < count; ++k)
    if (through[k] != Rgb(1))
      attenuations_.push_back({places_[first + static_cast<std::size_t>(k)], through[k]});
}

void PairBlock::shade_through() {
  shade();
  for (const Attenuation& a : attenuations_)
    for (std::uint32_t c = 0; c < 3; ++c)
      e_[3 * (a.place / 16) + c][a.place % 16] *= a.through[static_cast<int>(c)];
}

void PairBlock::trace(bool values) {
  values_wanted_ = values;
  attenuations_.clear();
  geometry::ShadowPacket packet;
  const std::size_t packets = (survivors_ + 15) / 16;
  for (std::size_t p = 0; p < packets; ++p) {
    const int count = static_cast<int>(std::min<std::size_t>(16, survivors_ - 16 * p));
    fill(packet, 16 * p, count);
    packet_bits_[p] = context_.rays->visible16(packet);
    if (context_.has_smooth && values && packet_bits_[p] != 0) {
      // What is hidden need not be attenuated.
      for (int k = 0; k < count; ++k)
        if (!(packet_bits_[p] >> k & 1)) packet.valid[k] = 0;
      note_transmittance(packet, 16 * p, count);
    }
  }
  packet_bits_[packets] = 0;
  std::size_t at = 0;  // bit of the next survivor
  for (std::size_t g = 0; g < groups_; ++g) {
    const std::uint32_t alive_bits = alive_[g];
    if (alive_bits == 0) {
      visible_[g] = 0;
      continue;
    }
    const std::uint32_t two = packet_bits_[at / 16] | static_cast<std::uint32_t>(packet_bits_[at / 16 + 1])
                                                          << 16;
    visible_[g] = static_cast<std::uint16_t>(deposit_bits(two >> (at % 16), alive_bits));
    at += static_cast<std::size_t>(__builtin_popcount(alive_bits));
  }
  shade_through();
}

void PairBlock::skip_visibility() {
  values_wanted_ = true;
  attenuations_.clear();
  std::copy_n(alive_.begin(), groups_, visible_.begin());
  if (context_.has_smooth) {
    geometry::ShadowPacket packet;
    for (std::size_t p = 0; 16 * p < survivors_; ++p) {
      const int count = static_cast<int>(std::min<std::size_t>(16, survivors_ - 16 * p));
      fill(packet, 16 * p, count);
      note_transmittance(packet, 16 * p, count);
    }
  }
  shade_through();
}

}  // namespace lumirank::transport
