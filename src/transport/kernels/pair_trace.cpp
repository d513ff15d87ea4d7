// The shadow rays of a block's survivors, 16 to a packet in the order of the pairs.
#include <algorithm>

#include "base/random.h"
#include "transport/kernels/pair_block.h"
#include "world/world.h"

namespace lumirank::transport {
namespace {

constexpr int kOrigin = 9 * 16, kTarget = 9 * 16;  // fields of RowGroup and ColumnGroup
constexpr int kPosition = 0, kGeometricNormal = 6 * 16;

}  // namespace

std::uint32_t PairBlock::row_slot(std::uint32_t place) const {
  switch (shape_) {
    case BlockShape::column:
      return first_slot_ + place;
    case BlockShape::row:
      return fixed_slot_;
    default:
      return row_list_[place];
  }
}

std::uint32_t PairBlock::column_slot(std::uint32_t place) const {
  switch (shape_) {
    case BlockShape::column:
      return fixed_slot_;
    case BlockShape::row:
      return first_slot_ + place;
    default:
      return column_list_[place];
  }
}

bool PairBlock::to_infinity(std::uint32_t slot) const {
  return context_.columns->plan.kind_of(slot) == kColumnDirectional;
}

void PairBlock::fill(geometry::ShadowPacket& packet, const std::uint32_t* places, int count) const {
  for (int k = 0; k < 16; ++k) {
    const std::uint32_t place = places[k < count ? k : 0];
    const std::uint32_t i = row_slot(place), j = column_slot(place);
    const float *row = context_.rows->at(i), *column = context_.columns->at(j);
    Vec3f origin = read3(row + kOrigin), target = read3(column + kTarget);
    const bool infinite = to_infinity(j);
    const bool row_turns = !context_.rows->two_sided.empty() && context_.rows->two_sided[i];
    const bool column_turns = !context_.columns->two_sided.empty() && context_.columns->two_sided[j];
    if (row_turns || column_turns) {
      const Vec3f p = read3(row + kPosition), y = read3(column + kPosition);
      const Vec3f w = infinite ? target : y - p;
      if (row_turns) origin = world::World::offset_origin(p, read3(row + kGeometricNormal), w);
      if (column_turns) target = world::World::offset_origin(y, read3(column + kGeometricNormal), -w);
    }
    const Vec3f direction = infinite ? target : target - origin;
    packet.ox[k] = origin.x, packet.oy[k] = origin.y, packet.oz[k] = origin.z;
    packet.dx[k] = direction.x, packet.dy[k] = direction.y, packet.dz[k] = direction.z;
    packet.t_far[k] = infinite ? kInfinity : 1.0f;
    packet.valid[k] = k < count ? -1 : 0;
    packet.key[k] = context_.has_cutouts
                        ? hash_ids(context_.seed, Stage::opacity, context_.rows->plan.item[i],
                                   context_.columns->plan.item[j])
                        : 0;
  }
}

void PairBlock::attenuate(const geometry::ShadowPacket& packet, const std::uint32_t* places, int count) {
  Rgb through[16];
  context_.rays->transmittance16(packet, through);
  for (int k = 0; k < count; ++k) {
    const std::uint32_t g = places[k] / 16, lane = places[k] % 16;
    for (std::uint32_t c = 0; c < 3; ++c) e_[3 * g + c][lane] *= through[k][static_cast<int>(c)];
  }
}

void PairBlock::trace() {
  geometry::ShadowPacket packet;
  const std::size_t packets = (survivors_ + 15) / 16;
  for (std::size_t p = 0; p < packets; ++p) {
    const int count = static_cast<int>(std::min<std::size_t>(16, survivors_ - 16 * p));
    const std::uint32_t* places = places_.data() + 16 * p;
    fill(packet, places, count);
    packet_bits_[p] = context_.rays->visible16(packet);
    if (context_.has_smooth && packet_bits_[p] != 0) attenuate(packet, places, count);
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
}

void PairBlock::skip_visibility() {
  std::copy_n(alive_.begin(), groups_, visible_.begin());
  if (!context_.has_smooth) return;
  geometry::ShadowPacket packet;
  for (std::size_t p = 0; 16 * p < survivors_; ++p) {
    const int count = static_cast<int>(std::min<std::size_t>(16, survivors_ - 16 * p));
    fill(packet, places_.data() + 16 * p, count);
    attenuate(packet, places_.data() + 16 * p, count);
  }
}

}  // namespace lumirank::transport
