#include "transport/cpu/pair_block.h"

#include <algorithm>
#include <array>

#include "base/error.h"

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
    const RowGroup* rows = b.context_.rows->groups.data() + b.tile_.first_slot / 16;
    for (std::size_t g = begin; g < end; ++g)
      b.lanes_.alive[g] =
          static_cast<std::uint16_t>(cull<row_kind, column_kind>(rows[g], b.partner_.column, extras));
  }

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void shade_column(PairBlock& b, std::size_t begin, std::size_t end, PairExtras extras) {
    if (kNeverBlack<row_kind, column_kind> && !b.values_wanted_) return;
    const RowGroup* rows = b.context_.rows->groups.data() + b.tile_.first_slot / 16;
    for (std::size_t g = begin; g < end; ++g) {
      if (b.lanes_.visible[g] == 0) continue;
      if constexpr (row_kind == kRowScatter) extras.row = &b.tile_.scatter[g];
      if constexpr (is_sphere(column_kind)) b.name_column_pairs(extras, g);
      b.keep(g, evaluate<row_kind, column_kind>(rows[g], b.partner_.column, extras));
    }
  }

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void cull_row(PairBlock& b, std::size_t begin, std::size_t end, PairExtras extras) {
    const ColumnGroup* columns = b.context_.columns->groups.data() + b.tile_.first_slot / 16;
    for (std::size_t g = begin; g < end; ++g) {
      if constexpr (column_kind == kColumnSpot) extras.spots = &b.tile_.spots[16 * g];
      b.lanes_.alive[g] =
          static_cast<std::uint16_t>(cull<row_kind, column_kind>(b.partner_.row, columns[g], extras));
    }
  }

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void shade_row(PairBlock& b, std::size_t begin, std::size_t end, PairExtras extras) {
    if (kNeverBlack<row_kind, column_kind> && !b.values_wanted_) return;
    const ColumnGroup* columns = b.context_.columns->groups.data() + b.tile_.first_slot / 16;
    for (std::size_t g = begin; g < end; ++g) {
      if (b.lanes_.visible[g] == 0) continue;
      if constexpr (scatters(column_kind)) extras.column = &b.tile_.scatter[g];
      if constexpr (column_kind == kColumnSpot) extras.spots = &b.tile_.spots[16 * g];
      if constexpr (is_sphere(column_kind)) b.name_row_pairs(extras, g);
      b.keep(g, evaluate<row_kind, column_kind>(b.partner_.row, columns[g], extras));
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
      context.rows->gather(b.list_.rows.data() + 16 * g, rows);
      context.columns->gather(b.list_.columns.data() + 16 * g, columns);
      extras = b.extras(context.rows->plan.kind_of(b.list_.rows[16 * g]),
                        context.columns->plan.kind_of(b.list_.columns[16 * g]));
      if constexpr (column_kind == kColumnSpot) {
        for (std::size_t k = 0; k < 16; ++k)
          spots[k] = b.spot_of(context.columns->plan.item[b.list_.columns[16 * g + k]]);
        extras.spots = spots;
      }
    }
  };

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void cull_list(PairBlock& b, std::size_t g, std::uint32_t used) {
    Listed listed;
    listed.gather<column_kind>(b, g);
    b.lanes_.alive[g] = static_cast<std::uint16_t>(
        used & cull<row_kind, column_kind>(listed.rows, listed.columns, listed.extras));
  }

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void shade_list(PairBlock& b, std::size_t g) {
    if (kNeverBlack<row_kind, column_kind> && !b.values_wanted_) return;
    const PairContext& context = b.context_;
    Listed listed;
    listed.gather<column_kind>(b, g);
    ScatterGroup row_scatter, column_scatter;
    std::uint32_t rows[16], columns[16], row_keys[16], column_keys[16];
    for (std::size_t k = 0; k < 16; ++k) {
      rows[k] = context.rows->plan.item[b.list_.rows[16 * g + k]];
      columns[k] = context.columns->plan.item[b.list_.columns[16 * g + k]];
      if constexpr (is_sphere(column_kind)) {
        row_keys[k] = context.rows->key[b.list_.rows[16 * g + k]];
        column_keys[k] = context.columns->key[b.list_.columns[16 * g + k]];
      }
    }
    b.partner_.arena.clear();
    if constexpr (row_kind == kRowScatter) {
      row_scatter = b.partner_.arena.fetch(context.row_scatter, rows);
      listed.extras.row = &row_scatter;
    }
    if constexpr (scatters(column_kind)) {
      column_scatter = b.partner_.arena.fetch(context.column_scatter, columns);
      listed.extras.column = &column_scatter;
    }
    if constexpr (is_sphere(column_kind)) {
      listed.extras.row_items = rows, listed.extras.column_items = columns;
      listed.extras.row_keys = row_keys, listed.extras.column_keys = column_keys;
      listed.extras.wanted = b.lanes_.visible[g];
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

void PairBlock::require(Stage min_stage, const char* call) const {
  if (stage_ < min_stage) throw InternalError(std::string("transport::PairBlock: too early for ") + call);
}

void PairBlock::resize(std::size_t groups) {
  groups_ = groups;
  e_.resize(std::max(e_.size(), 3 * groups));
  excess_.resize(std::max(excess_.size(), groups));
  for (auto* v : {&lanes_.alive, &lanes_.visible, &lanes_.clamped}) v->resize(std::max(v->size(), groups));
  survivors_.places.resize(std::max(survivors_.places.size(), 16 * groups + 16));
  for (auto* v : {&survivors_.end_x, &survivors_.end_y, &survivors_.end_z})
    v->resize(survivors_.places.size());
  survivors_.end_key.resize(survivors_.places.size());
  survivors_.packet_bits.resize(std::max(survivors_.packet_bits.size(), groups + 2));
}

void PairBlock::keep(std::size_t group, const PairResult& result) {
  e_[3 * group] = result.e.x, e_[3 * group + 1] = result.e.y, e_[3 * group + 2] = result.e.z;
  lanes_.visible[group] &= static_cast<std::uint16_t>(result.alive);
  lanes_.clamped[group] = static_cast<std::uint16_t>(result.clamped);
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
  extras.row_items = &context_.rows->plan.item[tile_.first_slot + 16 * group];
  extras.row_keys = &context_.rows->key[tile_.first_slot + 16 * group];
  extras.column_items = partner_.items.data();
  extras.column_keys = partner_.keys.data();
  extras.wanted = lanes_.visible[group];
}

void PairBlock::name_row_pairs(PairExtras& extras, std::size_t group) const {
  extras.row_items = partner_.items.data();
  extras.row_keys = partner_.keys.data();
  extras.column_items = &context_.columns->plan.item[tile_.first_slot + 16 * group];
  extras.column_keys = &context_.columns->key[tile_.first_slot + 16 * group];
  extras.wanted = lanes_.visible[group];
}

void PairBlock::set_row_tile(std::size_t tile) {
  const TilePlan& plan = context_.rows->plan;
  const auto runs = plan.tile(tile);
  stage_ = Stage::tile, shape_ = BlockShape::column, tile_.number = tile,
  tile_.first_slot = runs.front().begin;
  resize((runs.back().end - tile_.first_slot) / 16);
  tile_.arena.clear();
  tile_.scatter.resize(std::max(tile_.scatter.size(), groups_));
  for (const TilePlan::Run& run : runs) {
    if (run.kind < kRowScatter) continue;
    for (std::uint32_t s = run.begin; s < run.end; s += 16)
      tile_.scatter[(s - tile_.first_slot) / 16] = tile_.arena.fetch(context_.row_scatter, &plan.item[s]);
  }
}

void PairBlock::set_column_tile(std::size_t tile) {
  const TilePlan& plan = context_.columns->plan;
  const auto runs = plan.tile(tile);
  stage_ = Stage::tile, shape_ = BlockShape::row, tile_.number = tile, tile_.first_slot = runs.front().begin;
  resize((runs.back().end - tile_.first_slot) / 16);
  tile_.arena.clear();
  tile_.scatter.resize(std::max(tile_.scatter.size(), groups_));
  tile_.spots.resize(std::max(tile_.spots.size(), 16 * groups_));
  for (const TilePlan::Run& run : runs) {
    for (std::uint32_t s = run.begin; s < run.end; s += 16) {
      const std::uint32_t* items = &plan.item[s];
      if (run.kind >= kColumnScatter)
        tile_.scatter[(s - tile_.first_slot) / 16] = tile_.arena.fetch(context_.column_scatter, items);
      if (run.kind == kColumnSpot)
        for (std::uint32_t k = 0; k < 16; ++k) tile_.spots[s - tile_.first_slot + k] = spot_of(items[k]);
    }
  }
}

void PairBlock::set_column(std::uint32_t column_slot, float bound) {
  require(Stage::tile, "set_column");
  bound_ = bound;
  partner_.slot = column_slot;
  partner_.kind = context_.columns->plan.kind_of(column_slot);
  context_.columns->splat(column_slot, partner_.column);
  if (partner_.kind == kColumnSpot) partner_.spots.fill(spot_of(context_.columns->plan.item[column_slot]));
  partner_.items.fill(context_.columns->plan.item[column_slot]);
  if (context_.has_spheres) partner_.keys.fill(context_.columns->key[column_slot]);
  for (const TilePlan::Run& run : context_.rows->plan.tile(tile_.number)) {
    PairExtras extras = this->extras(run.kind, partner_.kind);
    extras.spots = partner_.spots.data();
    PairBlockKernels::pick(
        *this, run.kind, partner_.kind, [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
          PairBlockKernels::cull_column<row_kind, column_kind>(*this, (run.begin - tile_.first_slot) / 16,
                                                               (run.end - tile_.first_slot) / 16, extras);
        });
  }
  collect_survivors();
}

void PairBlock::set_row(std::uint32_t row_slot) {
  require(Stage::tile, "set_row");
  bound_ = kInfinity;
  partner_.slot = row_slot;
  partner_.kind = context_.rows->plan.kind_of(row_slot);
  context_.rows->splat(row_slot, partner_.row);
  partner_.items.fill(context_.rows->plan.item[row_slot]);
  if (context_.has_spheres) partner_.keys.fill(context_.rows->key[row_slot]);
  for (const TilePlan::Run& run : context_.columns->plan.tile(tile_.number))
    PairBlockKernels::pick(
        *this, partner_.kind, run.kind, [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
          PairBlockKernels::cull_row<row_kind, column_kind>(*this, (run.begin - tile_.first_slot) / 16,
                                                            (run.end - tile_.first_slot) / 16,
                                                            extras(partner_.kind, run.kind));
        });
  collect_survivors();
}

void PairBlock::set_list(std::span<const std::uint32_t> row_slots,
                         std::span<const std::uint32_t> column_slots, std::span<const std::uint16_t> used) {
  bound_ = kInfinity;
  shape_ = BlockShape::list, list_.rows = row_slots, list_.columns = column_slots, tile_.first_slot = 0;
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
  if (std::all_of(lanes_.visible.begin(), lanes_.visible.begin() + static_cast<std::ptrdiff_t>(groups_),
                  [](std::uint16_t lanes) { return lanes == 0; }))
    return;
  ScatterGroup scatter;
  partner_.arena.clear();
  switch (shape_) {
    case BlockShape::column:
      if (partner_.kind >= kColumnScatter)
        scatter = partner_.arena.fetch(context_.column_scatter, context_.columns->plan.item[partner_.slot]);
      for (const TilePlan::Run& run : context_.rows->plan.tile(tile_.number)) {
        PairExtras extras = this->extras(run.kind, partner_.kind);
        extras.column = &scatter, extras.spots = partner_.spots.data();
        PairBlockKernels::pick(
            *this, run.kind, partner_.kind, [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
              PairBlockKernels::shade_column<row_kind, column_kind>(
                  *this, (run.begin - tile_.first_slot) / 16, (run.end - tile_.first_slot) / 16, extras);
            });
      }
      return;
    case BlockShape::row:
      if (partner_.kind >= kRowScatter)
        scatter = partner_.arena.fetch(context_.row_scatter, context_.rows->plan.item[partner_.slot]);
      for (const TilePlan::Run& run : context_.columns->plan.tile(tile_.number)) {
        PairExtras extras = this->extras(partner_.kind, run.kind);
        extras.row = &scatter;
        PairBlockKernels::pick(
            *this, partner_.kind, run.kind, [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
              PairBlockKernels::shade_row<row_kind, column_kind>(*this, (run.begin - tile_.first_slot) / 16,
                                                                 (run.end - tile_.first_slot) / 16, extras);
            });
      }
      return;
    case BlockShape::list:
      for (std::size_t g = 0; g < groups_; ++g)
        if (lanes_.visible[g] != 0)
          PairBlockKernels::pick(*this, context_.rows->plan.kind_of(list_.rows[16 * g]),
                                 context_.columns->plan.kind_of(list_.columns[16 * g]),
                                 [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
                                   PairBlockKernels::shade_list<row_kind, column_kind>(*this, g);
                                 });
      return;
  }
}

void PairBlock::collect_survivors() {
  std::uint32_t* end = survivors_.places.data();
  for (std::size_t g = 0; g < groups_; ++g)
    if (lanes_.alive[g]) end = append_set_bits(lanes_.alive[g], static_cast<std::uint32_t>(16 * g), end);
  survivors_.count = static_cast<std::size_t>(end - survivors_.places.data());
  stage_ = Stage::pairs;
  if (shape_ == BlockShape::column) collect(*context_.rows, &RowGroup::origin);
  if (shape_ == BlockShape::row) collect(*context_.columns, &ColumnGroup::target);
}

template <typename Store>
void PairBlock::collect(const Store& store, Lane3 Store::Group::*field) {
  std::size_t at = 0;
  for (std::size_t g = 0; g < groups_; ++g) {
    const std::uint32_t alive = lanes_.alive[g];
    if (alive == 0) continue;
    const auto slot = static_cast<std::uint32_t>(tile_.first_slot + 16 * g);
    const Lane3& ends = store.groups[slot / 16].*field;
    append_lanes(alive, ends.x, &survivors_.end_x[at]), append_lanes(alive, ends.y, &survivors_.end_y[at]);
    append_lanes(alive, ends.z, &survivors_.end_z[at]);
    if (context_.has_cutouts) append_lanes(alive, &store.key[slot], &survivors_.end_key[at]);
    at += static_cast<std::size_t>(__builtin_popcount(alive));
  }
  if (at == 0) return;
  for (auto* v : {&survivors_.end_x, &survivors_.end_y, &survivors_.end_z})
    std::fill_n(v->begin() + at, 15, (*v)[at - 1]);
  if (context_.has_cutouts) std::fill_n(survivors_.end_key.begin() + at, 15, survivors_.end_key[at - 1]);
}

}  // namespace lumirank::transport
