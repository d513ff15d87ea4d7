// The shadow rays of a block's survivors, 16 to a packet in the order of the pairs.
#include <algorithm>

#include "base/random.h"
#include "transport/kernels/pair_block.h"
#include "world/world.h"

namespace lumirank::transport {
namespace {

// Fields of RowGroup and ColumnGroup.
constexpr int kOrigin = 9 * 16, kTarget = 9 * 16, kPosition = 0, kGeometricNormal = 6 * 16;

// Field `field` of 16 slots, as three arrays.
template <typename Store>
void gather(const Store& store, const std::uint32_t slots[16], int field, float* x, float* y, float* z) {
  for (int k = 0; k < 16; ++k) {
    const float* from = store.at(slots[k]) + field;
    x[k] = from[0], y[k] = from[16], z[k] = from[32];
  }
}

template <typename Store>
void repeat(const Store& from, std::uint32_t slot, int field, float* x, float* y, float* z) {
  const Vec3f v = read3(from.at(slot) + field);
  store(x, splat(v.x)), store(y, splat(v.y)), store(z, splat(v.z));
}

}  // namespace

// Where a surface shines through, the side from which a ray starts depends on its direction.
void PairBlock::turn_ends(geometry::ShadowPacket& packet, const std::uint32_t* rows,
                          const std::uint32_t* columns, float* tx, float* ty, float* tz) const {
  const auto &row_turns = context_.rows->two_sided, &column_turns = context_.columns->two_sided;
  for (int k = 0; k < 16; ++k) {
    const bool row = !row_turns.empty() && row_turns[rows[k]];
    const bool column = !column_turns.empty() && column_turns[columns[k]];
    if (!row && !column) continue;
    const float *r = context_.rows->at(rows[k]), *c = context_.columns->at(columns[k]);
    const Vec3f p = read3(r + kPosition), y = read3(c + kPosition);
    const Vec3f w = to_infinity(columns[k]) ? Vec3f{tx[k], ty[k], tz[k]} : y - p;
    if (row) {
      const Vec3f origin = world::World::offset_origin(p, read3(r + kGeometricNormal), w);
      packet.ox[k] = origin.x, packet.oy[k] = origin.y, packet.oz[k] = origin.z;
    }
    if (column) {
      const Vec3f target = world::World::offset_origin(y, read3(c + kGeometricNormal), -w);
      tx[k] = target.x, ty[k] = target.y, tz[k] = target.z;
    }
  }
}

void PairBlock::fill(geometry::ShadowPacket& packet, const std::uint32_t* places, int count) const {
  alignas(64) std::uint32_t rows[16], columns[16];
  alignas(64) float tx[16], ty[16], tz[16];
  alignas(64) std::uint32_t padded[16];
  if (count < 16) {
    for (int k = 0; k < 16; ++k) padded[k] = places[k < count ? k : 0];
    places = padded;
  }
  for (int k = 0; k < 16; ++k) packet.valid[k] = k < count ? -1 : 0;
  for (int k = 0; k < 16; ++k) {
    rows[k] = shape_ == BlockShape::column ? first_slot_ + places[k] : fixed_slot_;
    columns[k] = shape_ == BlockShape::row ? first_slot_ + places[k] : fixed_slot_;
  }
  if (shape_ == BlockShape::list)
    for (int k = 0; k < 16; ++k) rows[k] = row_list_[places[k]], columns[k] = column_list_[places[k]];

  if (shape_ == BlockShape::row) {
    repeat(*context_.rows, fixed_slot_, kOrigin, packet.ox, packet.oy, packet.oz);
  } else {
    gather(*context_.rows, rows, kOrigin, packet.ox, packet.oy, packet.oz);
  }
  if (shape_ == BlockShape::column) {
    repeat(*context_.columns, fixed_slot_, kTarget, tx, ty, tz);
  } else {
    gather(*context_.columns, columns, kTarget, tx, ty, tz);
  }
  if (!context_.rows->two_sided.empty() || !context_.columns->two_sided.empty())
    turn_ends(packet, rows, columns, tx, ty, tz);
  for (int k = 0; k < 16; ++k) {
    packet.dx[k] = tx[k] - packet.ox[k], packet.dy[k] = ty[k] - packet.oy[k],
    packet.dz[k] = tz[k] - packet.oz[k];
    packet.t_far[k] = 1;
  }
  if (context_.has_directional)
    for (int k = 0; k < 16; ++k)
      if (to_infinity(columns[k]))
        packet.dx[k] = tx[k], packet.dy[k] = ty[k], packet.dz[k] = tz[k], packet.t_far[k] = kInfinity;
  // The key only has to differ from pair to pair: whoever decides by it hashes it with the surface's ids.
  const std::uint64_t keyed = mix64(context_.seed);
  const std::uint32_t *row_items = context_.rows->plan.item.data(),
                      *column_items = context_.columns->plan.item.data();
  for (int k = 0; k < 16; ++k)
    packet.key[k] =
        context_.has_cutouts
            ? keyed ^ (static_cast<std::uint64_t>(row_items[rows[k]]) << 32 | column_items[columns[k]])
            : 0;
}

bool PairBlock::to_infinity(std::uint32_t slot) const {
  return context_.columns->plan.kind_of(slot) == kColumnDirectional;
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
    if (context_.has_smooth && packet_bits_[p] != 0) {
      // What is hidden need not be attenuated.
      for (int k = 0; k < count; ++k)
        if (!(packet_bits_[p] >> k & 1)) packet.valid[k] = 0;
      attenuate(packet, places, count);
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
