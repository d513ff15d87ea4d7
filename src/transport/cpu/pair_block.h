// E of many pairs at once, in tiles; the survivors' shadow rays are packed in the order of the pairs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"
#include "matrix/lighting_matrix.h"
#include "transport/pairs/groups.h"
#include "transport/pairs/pair_kernel.h"
#include "transport/pairs/scatter_group.h"
#include "transport/pairs/sphere_kernel.h"

namespace lumirank::transport {

// What all blocks of one matrix share.
struct PairContext {
  const RowStore* rows;
  const ColumnStore* columns;
  ScatterSide row_scatter, column_scatter;
  const VirtualLights* lights;
  const geometry::RayScene* rays;
  std::uint64_t pair_seed;  // hashed once: with the two ids it decides cut-outs
  float clamp;              // X; infinite: off
  bool compensated;         // what clamping takes is given back elsewhere
  bool has_cutouts;         // rays need keys
  bool has_spheres;         // surface lights are spherical
  SphereBackground spheres;
  bool has_attenuating;  // rays need transmittances
  bool has_directional;
  bool has_two_sided;  // some surface shines through or is a fiber, see GroupStore::two_sided
};

// The pairs of a block in one of three shapes. Places count from 0 within the block, 16 to a group.
enum class BlockShape {
  column,  // a tile of receivers × one light
  row,     // one receiver × a tile of lights
  list,    // listed slots on both sides
};

// Use: a tile and then one partner after another, or a list; each followed by trace() or skip_visibility(),
// after which E and visibility can be read. InternalError out of this order. Rays come before E: most pairs
// are hidden, and E of a glossy pair costs more than its ray.
class PairBlock {
 public:
  explicit PairBlock(const PairContext& context) : context_(context) {}

  void set_row_tile(std::size_t tile);
  void set_column_tile(std::size_t tile);
  // After set_row_tile. bound: of a_j·G·(π f_x)(π f_y) beside X, where the column stands for others as well.
  void set_column(std::uint32_t column_slot, float bound = kInfinity);
  void set_row(std::uint32_t row_slot);  // after set_column_tile
  // All pairs of a group have one class of receiver and one of light. Padding repeats a neighbor; `used`: a
  // bit per lane that is not padding, by group. The spans must last until E has been read.
  void set_list(std::span<const std::uint32_t> row_slots, std::span<const std::uint32_t> column_slots,
                std::span<const std::uint16_t> used);

  // Shoots the survivors' rays and evaluates what they reach: afterwards visible(group) tells which lanes are
  // unblocked and not zero, and e is theirs, transmittance of attenuating surfaces included. Without
  // `values`, e is not to be read, and what can be told without it is not evaluated.
  void trace(bool values = true);
  // Takes all survivors as visible.
  void skip_visibility();

  std::size_t groups() const { return groups_; }
  // Only where lanes are visible.
  Lane3 e(std::size_t group) const { return {e_[3 * group], e_[3 * group + 1], e_[3 * group + 2]}; }
  std::uint32_t visible(std::size_t group) const { return lanes_.visible[group]; }
  std::size_t survivors() const { return survivors_.count; }
  std::uint32_t first_slot() const { return tile_.first_slot; }
  // Σ r + g + b of visible entries, and what clamping took away from them; in the order of places.
  double visible_energy() const;
  double removed_energy() const;

  // Σ weight · E over the channels, 0 where it is not visible: use(group, 16 floats).
  template <typename Use>
  void scalars(Rgb weights, Use&& use) const {
    for (std::size_t g = 0; g < groups_; ++g) {
      const Lane sum = select(mask_from_bits(lanes_.visible[g]), dot(splat(weights), e(g)), Lane{});
      float lanes[kLanes];
      store(lanes, sum);
      use(g, lanes);
    }
  }
  // sums += scale · shares[of[place]] · E; sums: 16 × r, g, b by group.
  void add_shares(Rgb scale, std::span<const float> shares, std::span<const std::uint32_t> of,
                  std::span<float> sums) const;

  // Running sums of the receivers of a row tile, in registers' order: sums += scale · E · V, column by
  // column.
  void load_sums(std::span<const Rgb> sums);
  double add_to_sums(Rgb scale);                 // returns the energy that clamping took away
  double store_sums(std::span<Rgb> sums) const;  // returns Σ r + g + b of what was added since load_sums

 private:
  friend struct PairBlockKernels;
  void resize(std::size_t groups);
  const SpotShape* spot_of(std::uint32_t light) const;
  PairExtras extras(std::uint16_t row_kind, std::uint16_t column_kind) const;
  // Which pairs a group of a tile holds, for kernels that draw random numbers.
  void name_column_pairs(PairExtras& extras, std::size_t group) const;
  void name_row_pairs(PairExtras& extras, std::size_t group) const;
  void keep(std::size_t group, const PairResult& result);
  void collect_survivors();
  template <typename Store>
  void collect(const Store& store, Lane3 Store::Group::*field);
  bool to_infinity(std::uint32_t column_slot) const;
  std::uint32_t row_slot(std::uint32_t place) const;
  std::uint32_t column_slot(std::uint32_t place) const;
  void orient_endpoints(const std::uint32_t* places, int count, Lane3& origin, Lane3& target) const;
  // The rays of survivors first … first + count - 1.
  void fill(geometry::ShadowPacket& packet, std::size_t first, int count) const;
  void note_transmittance(const geometry::ShadowPacket& packet, std::size_t first, int count);
  void shade();
  void apply_transmittance();  // with what attenuating surfaces let pass

  // A tile of receivers or of lights.
  struct Tile {
    std::size_t number = 0;
    std::uint32_t first_slot = 0;  // lists: 0
    ScatterArena arena;
    std::vector<ScatterGroup> scatter;  // by group; only runs that need it
    std::vector<const SpotShape*> spots;
  };
  // The one light or receiver that a tile meets.
  struct Partner {
    std::uint32_t slot = 0;
    std::uint16_t kind = 0;
    RowGroup row;
    ColumnGroup column;
    std::array<const SpotShape*, 16> spots;
    std::array<std::uint32_t, 16> items, keys;  // spherical lights only
    ScatterArena arena;                         // of a list: what both ends of a group scatter
  };
  struct List {
    std::span<const std::uint32_t> rows, columns;  // slots
  };
  // Bits of 16 lanes, by group.
  struct Lanes {
    std::vector<std::uint16_t> alive;    // E may be other than 0
    std::vector<std::uint16_t> visible;  // of these, unblocked
    std::vector<std::uint16_t> clamped;
  };
  struct Attenuation {
    std::uint32_t place;
    Rgb through;
  };
  // The pairs that are alive, one after the other, and their rays.
  struct Survivors {
    std::size_t count = 0;
    std::vector<std::uint32_t> places;
    // Of a tile: where the rays start (column) or end (row), and the key there. After the last there are 15
    // copies of it.
    std::vector<float> end_x, end_y, end_z;
    std::vector<std::uint32_t> end_key;
    std::vector<std::uint16_t> packet_bits;  // what is unblocked, 16 survivors to a packet
    std::vector<Attenuation> attenuations;
  };
  // What may be asked of the block, see above.
  enum class Stage : std::uint8_t { empty, tile, pairs, evaluated };
  void require(Stage min_stage, const char* call) const;

  const PairContext& context_;
  BlockShape shape_ = BlockShape::column;
  Stage stage_ = Stage::empty;
  std::size_t groups_ = 0;
  bool values_wanted_ = true;
  float bound_ = kInfinity;  // of the pairs at hand, beside X
  Tile tile_;
  Partner partner_;
  List list_;
  Lanes lanes_;
  Survivors survivors_;
  std::vector<Lane> e_, excess_, sums_;
};

// Finishes an evaluated block: rays where they are needed, and the cost, all but what of it is lost. `pairs`:
// without padding.
matrix::Cost finish(PairBlock& block, matrix::Part part, std::size_t pairs);

// The cost of a whole call.
inline matrix::Cost with_loss(const PairContext& context, matrix::Cost cost) {
  cost.lost = context.compensated ? 0 : cost.clamped;
  return cost;
}

// Copies what was asked for to out(items[place]), leaving out the places of kNoItem.
template <typename Out>
void copy_out(const PairBlock& block, matrix::Part part, std::span<const std::uint32_t> items, Out&& out) {
  for (std::size_t g = 0; g < block.groups(); ++g) {
    const Lane3 e = block.e(g);
    const std::uint32_t seen = block.visible(g);
    for (int k = 0; k < kLanes; ++k) {
      const std::uint32_t item = items[16 * g + static_cast<std::size_t>(k)];
      if (item == kNoItem) continue;
      const bool lit = seen >> k & 1;
      out(item) = !lit ? Rgb(0) : part == matrix::Part::visibility ? Rgb(1) : Rgb(e.x[k], e.y[k], e.z[k]);
    }
  }
}

}  // namespace lumirank::transport
