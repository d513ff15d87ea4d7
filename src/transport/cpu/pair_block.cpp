#include "transport/cpu/pair_block.h"

#include <algorithm>
#include <array>

namespace lumirank::transport {
namespace {

template <std::uint16_t row_kind, ColumnKind column_kind>
std::uint32_t cull(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras) {
  if constexpr (is_sphere(column_kind)) {
    return bits(sphere_geometry<row_kind, column_kind>(r, c, extras).alive);
  } else {
    return cull_pair<row_kind, column_kind>(r, c, extras);
  }
}

template <std::uint16_t row_kind, ColumnKind column_kind>
PairResult evaluate(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras) {
  if constexpr (is_sphere(column_kind)) {
    return evaluate_sphere<row_kind, column_kind>(r, c, extras);
  } else {
    return evaluate_pair<row_kind, column_kind>(r, c, extras);
  }
}

// Between these a pair that is not culled has E ≠ 0: black ends are culled by their depths.
template <std::uint16_t row_kind, ColumnKind column_kind>
constexpr bool kNeverBlack = row_kind == kRowLambertian &&
                             (column_kind == kColumnOmni || column_kind == kColumnFacing ||
                              column_kind == kColumnDirectional);

}  // namespace

// The loops over groups, compiled for each class of receiver and light: `cull` finds the survivors, `shade`
// evaluates the groups with visible lanes.
struct PairBlockKernels {
  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void cull_column(PairBlock& b, std::size_t begin, std::size_t end, const PairExtras& extras) {
    const RowGroup* rows = b.context_.rows->groups.data() + b.first_slot_ / 16;
    for (std::size_t g = begin; g < end; ++g)
      b.alive_[g] = static_cast<std::uint16_t>(cull<row_kind, column_kind>(rows[g], b.fixed_column_, extras));
  }

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void shade_column(PairBlock& b, std::size_t begin, std::size_t end, PairExtras extras) {
    if (kNeverBlack<row_kind, column_kind> && !b.values_wanted_) return;
    const RowGroup* rows = b.context_.rows->groups.data() + b.first_slot_ / 16;
    for (std::size_t g = begin; g < end; ++g) {
      if (b.visible_[g] == 0) continue;
      if constexpr (row_kind == kRowScatter) extras.row = &b.tile_scatter_[g];
      if constexpr (is_sphere(column_kind)) b.name_column_pairs(extras, g);
      b.keep(g, evaluate<row_kind, column_kind>(rows[g], b.fixed_column_, extras));
    }
  }

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void cull_row(PairBlock& b, std::size_t begin, std::size_t end, PairExtras extras) {
    const ColumnGroup* columns = b.context_.columns->groups.data() + b.first_slot_ / 16;
    for (std::size_t g = begin; g < end; ++g) {
      if constexpr (column_kind == kColumnSpot) extras.spots = &b.tile_spots_[16 * g];
      b.alive_[g] = static_cast<std::uint16_t>(cull<row_kind, column_kind>(b.fixed_row_, columns[g], extras));
    }
  }

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void shade_row(PairBlock& b, std::size_t begin, std::size_t end, PairExtras extras) {
    if (kNeverBlack<row_kind, column_kind> && !b.values_wanted_) return;
    const ColumnGroup* columns = b.context_.columns->groups.data() + b.first_slot_ / 16;
    for (std::size_t g = begin; g < end; ++g) {
      if (b.visible_[g] == 0) continue;
      if constexpr (scatters(column_kind)) extras.column = &b.tile_scatter_[g];
      if constexpr (column_kind == kColumnSpot) extras.spots = &b.tile_spots_[16 * g];
      if constexpr (is_sphere(column_kind)) b.name_row_pairs(extras, g);
      b.keep(g, evaluate<row_kind, column_kind>(b.fixed_row_, columns[g], extras));
    }
  }

  // Both ends of a group of a list.
  struct Listed {
    RowGroup rows;
    ColumnGroup columns;
    const SpotShape* spots[16];
    PairExtras extras;
    template <ColumnKind column_kind>
    void gather(const PairBlock& b, std::size_t g) {
      const PairContext& context = b.context_;
      context.rows->gather(b.row_list_.data() + 16 * g, rows);
      context.columns->gather(b.column_list_.data() + 16 * g, columns);
      extras = b.extras(context.rows->plan.kind_of(b.row_list_[16 * g]),
                        context.columns->plan.kind_of(b.column_list_[16 * g]));
      if constexpr (column_kind == kColumnSpot) {
        for (std::size_t k = 0; k < 16; ++k)
          spots[k] = b.spot_of(context.columns->plan.item[b.column_list_[16 * g + k]]);
        extras.spots = spots;
      }
    }
  };

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void cull_list(PairBlock& b, std::size_t g, std::uint32_t used) {
    Listed listed;
    listed.gather<column_kind>(b, g);
    b.alive_[g] = static_cast<std::uint16_t>(
        used & cull<row_kind, column_kind>(listed.rows, listed.columns, listed.extras));
  }

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void shade_list(PairBlock& b, std::size_t g) {
    if (kNeverBlack<row_kind, column_kind> && !b.values_wanted_) return;
    const PairContext& context = b.context_;
    Listed listed;
    listed.gather<column_kind>(b, g);
    ScatterGroup row_scatter, column_scatter;
    std::uint32_t rows[16], columns[16], keys[16];
    for (std::size_t k = 0; k < 16; ++k) {
      rows[k] = context.rows->plan.item[b.row_list_[16 * g + k]];
      columns[k] = context.columns->plan.item[b.column_list_[16 * g + k]];
      if constexpr (is_sphere(column_kind)) keys[k] = context.rows->key[b.row_list_[16 * g + k]];
    }
    b.partner_arena_.clear();
    if constexpr (row_kind == kRowScatter) {
      row_scatter = b.partner_arena_.fetch(context.row_scatter, rows);
      listed.extras.row = &row_scatter;
    }
    if constexpr (scatters(column_kind)) {
      column_scatter = b.partner_arena_.fetch(context.column_scatter, columns);
      listed.extras.column = &column_scatter;
    }
    if constexpr (is_sphere(column_kind)) {
      listed.extras.row_items = rows, listed.extras.column_items = columns, listed.extras.row_keys = keys;
      listed.extras.wanted = b.visible_[g];
    }
    b.keep(g, evaluate<row_kind, column_kind>(listed.rows, listed.columns, listed.extras));
  }

  // Calls use.template operator()<row_kind, column_kind>() for the classes at hand.
  template <typename Use>
  static void pick(const PairBlock& b, std::uint16_t row_kind, std::uint16_t column_kind, Use&& use) {
    if (column_kind >= kColumnScatter && b.context_.has_spheres) column_kind = kColumnScatterSphere;
    if (row_kind == kRowLambertian) {
      pick_column<kRowLambertian>(column_kind, use);
    } else {
      pick_column<kRowScatter>(column_kind, use);
    }
  }
  template <std::uint16_t row_kind, typename Use>
  static void pick_column(std::uint16_t column_kind, Use& use) {
    switch (column_kind) {
      case kColumnOmni:
        return use.template operator()<row_kind, kColumnOmni>();
      case kColumnFacing:
        return use.template operator()<row_kind, kColumnFacing>();
      case kColumnDirectional:
        return use.template operator()<row_kind, kColumnDirectional>();
      case kColumnSpot:
        return use.template operator()<row_kind, kColumnSpot>();
      case kColumnSphere:
        return use.template operator()<row_kind, kColumnSphere>();
      case kColumnScatterSphere:
        return use.template operator()<row_kind, kColumnScatterSphere>();
      default:
        return use.template operator()<row_kind, kColumnScatter>();
    }
  }
};

void PairBlock::resize(std::size_t groups) {
  groups_ = groups;
  e_.resize(std::max(e_.size(), 3 * groups));
  excess_.resize(std::max(excess_.size(), groups));
  for (auto* v : {&alive_, &visible_, &clamped_}) v->resize(std::max(v->size(), groups));
  places_.resize(std::max(places_.size(), 16 * groups + 16));
  for (auto* v : {&end_x_, &end_y_, &end_z_}) v->resize(places_.size());
  end_key_.resize(places_.size());
  packet_bits_.resize(std::max(packet_bits_.size(), groups + 2));
}

void PairBlock::keep(std::size_t group, const PairResult& result) {
  e_[3 * group] = result.e.x, e_[3 * group + 1] = result.e.y, e_[3 * group + 2] = result.e.z;
  visible_[group] &= static_cast<std::uint16_t>(result.alive);
  clamped_[group] = static_cast<std::uint16_t>(result.clamped);
  if (result.clamped) excess_[group] = result.excess;
}

const SpotShape* PairBlock::spot_of(std::uint32_t light) const {
  return light == kNoItem ? nullptr : &context_.lights->spots[context_.lights->closure[light]];
}

PairExtras PairBlock::extras(std::uint16_t row_kind, std::uint16_t column_kind) const {
  PairExtras extras;
  const bool sphere = column_kind == kColumnSphere || (column_kind >= kColumnScatter && context_.has_spheres);
  extras.clamp = sphere ? bound_ : std::min(context_.clamp, bound_);
  extras.spheres = &context_.spheres;
  if (row_kind >= kRowScatter)
    extras.row_sides =
        (*context_.row_scatter.forms)[static_cast<std::uint16_t>(row_kind - kRowScatter)].sides;
  if (column_kind >= kColumnScatter)
    extras.column_sides =
        (*context_.column_scatter.forms)[static_cast<std::uint16_t>(column_kind - kColumnScatter)].sides;
  return extras;
}

void PairBlock::name_column_pairs(PairExtras& extras, std::size_t group) const {
  extras.row_items = &context_.rows->plan.item[first_slot_ + 16 * group];
  extras.row_keys = &context_.rows->key[first_slot_ + 16 * group];
  extras.column_items = fixed_items_.data();
  extras.wanted = visible_[group];
}

void PairBlock::name_row_pairs(PairExtras& extras, std::size_t group) const {
  extras.row_items = fixed_items_.data();
  extras.row_keys = fixed_keys_.data();
  extras.column_items = &context_.columns->plan.item[first_slot_ + 16 * group];
  extras.wanted = visible_[group];
}

void PairBlock::set_row_tile(std::size_t tile) {
  const TilePlan& plan = context_.rows->plan;
  const auto runs = plan.tile(tile);
  shape_ = BlockShape::column, tile_ = tile, first_slot_ = runs.front().begin;
  resize((runs.back().end - first_slot_) / 16);
  tile_arena_.clear();
  tile_scatter_.resize(std::max(tile_scatter_.size(), groups_));
  for (const TilePlan::Run& run : runs) {
    if (run.kind < kRowScatter) continue;
    for (std::uint32_t s = run.begin; s < run.end; s += 16)
      tile_scatter_[(s - first_slot_) / 16] = tile_arena_.fetch(context_.row_scatter, &plan.item[s]);
  }
}

void PairBlock::set_column_tile(std::size_t tile) {
  const TilePlan& plan = context_.columns->plan;
  const auto runs = plan.tile(tile);
  shape_ = BlockShape::row, tile_ = tile, first_slot_ = runs.front().begin;
  resize((runs.back().end - first_slot_) / 16);
  tile_arena_.clear();
  tile_scatter_.resize(std::max(tile_scatter_.size(), groups_));
  tile_spots_.resize(std::max(tile_spots_.size(), 16 * groups_));
  for (const TilePlan::Run& run : runs) {
    for (std::uint32_t s = run.begin; s < run.end; s += 16) {
      const std::uint32_t* items = &plan.item[s];
      if (run.kind >= kColumnScatter)
        tile_scatter_[(s - first_slot_) / 16] = tile_arena_.fetch(context_.column_scatter, items);
      if (run.kind == kColumnSpot)
        for (std::uint32_t k = 0; k < 16; ++k) tile_spots_[s - first_slot_ + k] = spot_of(items[k]);
    }
  }
}

void PairBlock::set_column(std::uint32_t column_slot, float bound) {
  bound_ = bound;
  fixed_slot_ = column_slot;
  fixed_kind_ = context_.columns->plan.kind_of(column_slot);
  context_.columns->splat(column_slot, fixed_column_);
  if (fixed_kind_ == kColumnSpot) fixed_spots_.fill(spot_of(context_.columns->plan.item[column_slot]));
  fixed_items_.fill(context_.columns->plan.item[column_slot]);
  for (const TilePlan::Run& run : context_.rows->plan.tile(tile_)) {
    PairExtras extras = this->extras(run.kind, fixed_kind_);
    extras.spots = fixed_spots_.data();
    PairBlockKernels::pick(*this, run.kind, fixed_kind_,
                           [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
                             PairBlockKernels::cull_column<row_kind, column_kind>(
                                 *this, (run.begin - first_slot_) / 16, (run.end - first_slot_) / 16, extras);
                           });
  }
  collect_survivors();
}

void PairBlock::set_row(std::uint32_t row_slot) {
  bound_ = kInfinity;
  fixed_slot_ = row_slot;
  fixed_kind_ = context_.rows->plan.kind_of(row_slot);
  context_.rows->splat(row_slot, fixed_row_);
  fixed_items_.fill(context_.rows->plan.item[row_slot]);
  if (context_.has_spheres) fixed_keys_.fill(context_.rows->key[row_slot]);
  for (const TilePlan::Run& run : context_.columns->plan.tile(tile_))
    PairBlockKernels::pick(
        *this, fixed_kind_, run.kind, [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
          PairBlockKernels::cull_row<row_kind, column_kind>(*this, (run.begin - first_slot_) / 16,
                                                            (run.end - first_slot_) / 16,
                                                            extras(fixed_kind_, run.kind));
        });
  collect_survivors();
}

void PairBlock::set_list(std::span<const std::uint32_t> row_slots,
                         std::span<const std::uint32_t> column_slots, std::span<const std::uint16_t> used) {
  bound_ = kInfinity;
  shape_ = BlockShape::list, row_list_ = row_slots, column_list_ = column_slots, first_slot_ = 0;
  resize(used.size());
  for (std::size_t g = 0; g < groups_; ++g)
    PairBlockKernels::pick(*this, context_.rows->plan.kind_of(row_slots[16 * g]),
                           context_.columns->plan.kind_of(column_slots[16 * g]),
                           [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
                             PairBlockKernels::cull_list<row_kind, column_kind>(*this, g, used[g]);
                           });
  collect_survivors();
}

void PairBlock::shade() {
  if (std::all_of(visible_.begin(), visible_.begin() + static_cast<std::ptrdiff_t>(groups_),
                  [](std::uint16_t lanes) { return lanes == 0; }))
    return;
  ScatterGroup scatter;
  partner_arena_.clear();
  switch (shape_) {
    case BlockShape::column:
      if (fixed_kind_ >= kColumnScatter)
        scatter = partner_arena_.fetch(context_.column_scatter, context_.columns->plan.item[fixed_slot_]);
      for (const TilePlan::Run& run : context_.rows->plan.tile(tile_)) {
        PairExtras extras = this->extras(run.kind, fixed_kind_);
        extras.column = &scatter, extras.spots = fixed_spots_.data();
        PairBlockKernels::pick(
            *this, run.kind, fixed_kind_, [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
              PairBlockKernels::shade_column<row_kind, column_kind>(*this, (run.begin - first_slot_) / 16,
                                                                    (run.end - first_slot_) / 16, extras);
            });
      }
      return;
    case BlockShape::row:
      if (fixed_kind_ >= kRowScatter)
        scatter = partner_arena_.fetch(context_.row_scatter, context_.rows->plan.item[fixed_slot_]);
      for (const TilePlan::Run& run : context_.columns->plan.tile(tile_)) {
        PairExtras extras = this->extras(fixed_kind_, run.kind);
        extras.row = &scatter;
        PairBlockKernels::pick(
            *this, fixed_kind_, run.kind, [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
              PairBlockKernels::shade_row<row_kind, column_kind>(*this, (run.begin - first_slot_) / 16,
                                                                 (run.end - first_slot_) / 16, extras);
            });
      }
      return;
    case BlockShape::list:
      for (std::size_t g = 0; g < groups_; ++g)
        if (visible_[g] != 0)
          PairBlockKernels::pick(*this, context_.rows->plan.kind_of(row_list_[16 * g]),
                                 context_.columns->plan.kind_of(column_list_[16 * g]),
                                 [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
                                   PairBlockKernels::shade_list<row_kind, column_kind>(*this, g);
                                 });
      return;
  }
}

void PairBlock::collect_survivors() {
  std::uint32_t* end = places_.data();
  for (std::size_t g = 0; g < groups_; ++g)
    if (alive_[g]) end = append_set_bits(alive_[g], static_cast<std::uint32_t>(16 * g), end);
  survivors_ = static_cast<std::size_t>(end - places_.data());
  if (shape_ == BlockShape::column) collect(*context_.rows, kOriginField);
  if (shape_ == BlockShape::row) collect(*context_.columns, kTargetField);
}

template <typename Store>
void PairBlock::collect(const Store& store, int field) {
  std::size_t at = 0;
  for (std::size_t g = 0; g < groups_; ++g) {
    const std::uint32_t alive = alive_[g];
    if (alive == 0) continue;
    const auto slot = static_cast<std::uint32_t>(first_slot_ + 16 * g);
    const float* v = store.at(slot) + field;
    append_lanes(alive, load(v), &end_x_[at]), append_lanes(alive, load(v + 16), &end_y_[at]);
    append_lanes(alive, load(v + 32), &end_z_[at]);
    if (context_.has_cutouts) append_lanes(alive, &store.key[slot], &end_key_[at]);
    at += static_cast<std::size_t>(__builtin_popcount(alive));
  }
  if (at == 0) return;
  for (auto* v : {&end_x_, &end_y_, &end_z_}) std::fill_n(v->begin() + at, 15, (*v)[at - 1]);
  if (context_.has_cutouts) std::fill_n(end_key_.begin() + at, 15, end_key_[at - 1]);
}

}  // namespace lumirank::transport
