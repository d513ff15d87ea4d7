#include "transport/kernels/pair_block.h"

#include <algorithm>
#include <array>

namespace lumirank::transport {

// The three loops over groups, compiled for each class of receiver and light.
struct PairBlockKernels {
  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void column(PairBlock& b, std::size_t begin, std::size_t end, const ColumnGroup& light,
                     PairExtras extras) {
    const RowGroup* rows = b.context_.rows->groups.data() + b.first_slot_ / 16;
    for (std::size_t g = begin; g < end; ++g) {
      if constexpr (row_kind == kRowScatter) extras.row = &b.tile_scatter_[g];
      b.keep(g, evaluate_pair<row_kind, column_kind>(rows[g], light, extras));
    }
  }

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void row(PairBlock& b, std::size_t begin, std::size_t end, const RowGroup& receiver,
                  PairExtras extras) {
    const ColumnGroup* columns = b.context_.columns->groups.data() + b.first_slot_ / 16;
    for (std::size_t g = begin; g < end; ++g) {
      if constexpr (column_kind == kColumnScatter) extras.column = &b.tile_scatter_[g];
      if constexpr (column_kind == kColumnSpot) extras.spots = &b.tile_spots_[16 * g];
      b.keep(g, evaluate_pair<row_kind, column_kind>(receiver, columns[g], extras));
    }
  }

  template <std::uint16_t row_kind, ColumnKind column_kind>
  static void list(PairBlock& b, std::size_t g, std::uint32_t used) {
    const PairContext& context = b.context_;
    const std::uint32_t *row_slots = b.row_list_.data() + 16 * g,
                        *column_slots = b.column_list_.data() + 16 * g;
    RowGroup rows;
    ColumnGroup columns;
    context.rows->gather(row_slots, rows);
    context.columns->gather(column_slots, columns);
    PairExtras extras;
    extras.clamp = context.clamp;
    ScatterGroup row_scatter, column_scatter;
    const SpotShape* spots[16];
    std::uint32_t items[16];
    b.partner_arena_.clear();
    if constexpr (row_kind == kRowScatter) {
      for (int k = 0; k < 16; ++k) items[k] = context.rows->plan.item[row_slots[k]];
      row_scatter = b.partner_arena_.fetch(context.row_scatter, items);
      extras.row = &row_scatter;
    }
    for (int k = 0; k < 16; ++k) items[k] = context.columns->plan.item[column_slots[k]];
    if constexpr (column_kind == kColumnScatter) {
      column_scatter = b.partner_arena_.fetch(context.column_scatter, items);
      extras.column = &column_scatter;
    }
    if constexpr (column_kind == kColumnSpot) {
      for (int k = 0; k < 16; ++k) spots[k] = &context.lights->spots[context.lights->closure[items[k]]];
      extras.spots = spots;
    }
    PairResult result = evaluate_pair<row_kind, column_kind>(rows, columns, extras);
    result.alive &= used;
    result.clamped &= used;
    b.keep(g, result);
  }

  // Calls use.template operator()<row_kind, column_kind>() for the classes at hand.
  template <typename Use>
  static void pick(std::uint16_t row_kind, std::uint16_t column_kind, Use&& use) {
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
  end_item_.resize(places_.size());
  packet_bits_.resize(std::max(packet_bits_.size(), groups + 2));
}

void PairBlock::keep(std::size_t group, const PairResult& result) {
  e_[3 * group] = result.e.x, e_[3 * group + 1] = result.e.y, e_[3 * group + 2] = result.e.z;
  alive_[group] = static_cast<std::uint16_t>(result.alive);
  clamped_[group] = static_cast<std::uint16_t>(result.clamped & result.alive);
  if (result.clamped) excess_[group] = result.excess;
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
        for (int k = 0; k < 16; ++k)
          tile_spots_[s - first_slot_ + static_cast<std::uint32_t>(k)] =
              items[k] == kNoItem ? nullptr : &context_.lights->spots[context_.lights->closure[items[k]]];
    }
  }
}

void PairBlock::evaluate_column(std::uint32_t column_slot) {
  fixed_slot_ = column_slot;
  ColumnGroup light;
  context_.columns->splat(column_slot, light);
  const std::uint16_t kind = context_.columns->plan.kind_of(column_slot);
  const std::uint32_t item = context_.columns->plan.item[column_slot];
  PairExtras extras;
  extras.clamp = context_.clamp;
  ScatterGroup scatter;
  std::array<const SpotShape*, 16> spots;
  if (kind >= kColumnScatter) {
    partner_arena_.clear();
    scatter = partner_arena_.fetch(context_.column_scatter, item);
    extras.column = &scatter;
  } else if (kind == kColumnSpot) {
    spots.fill(&context_.lights->spots[context_.lights->closure[item]]);
    extras.spots = spots.data();
  }
  for (const TilePlan::Run& run : context_.rows->plan.tile(tile_))
    PairBlockKernels::pick(run.kind, kind, [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
      PairBlockKernels::column<row_kind, column_kind>(*this, (run.begin - first_slot_) / 16,
                                                      (run.end - first_slot_) / 16, light, extras);
    });
  collect_survivors();
}

void PairBlock::evaluate_row(std::uint32_t row_slot) {
  fixed_slot_ = row_slot;
  RowGroup receiver;
  context_.rows->splat(row_slot, receiver);
  const std::uint16_t kind = context_.rows->plan.kind_of(row_slot);
  PairExtras extras;
  extras.clamp = context_.clamp;
  ScatterGroup scatter;
  if (kind >= kRowScatter) {
    partner_arena_.clear();
    scatter = partner_arena_.fetch(context_.row_scatter, context_.rows->plan.item[row_slot]);
    extras.row = &scatter;
  }
  for (const TilePlan::Run& run : context_.columns->plan.tile(tile_))
    PairBlockKernels::pick(kind, run.kind, [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
      PairBlockKernels::row<row_kind, column_kind>(*this, (run.begin - first_slot_) / 16,
                                                   (run.end - first_slot_) / 16, receiver, extras);
    });
  collect_survivors();
}

void PairBlock::evaluate_list(std::span<const std::uint32_t> row_slots,
                              std::span<const std::uint32_t> column_slots,
                              std::span<const std::uint16_t> used) {
  shape_ = BlockShape::list, row_list_ = row_slots, column_list_ = column_slots, first_slot_ = 0;
  resize(used.size());
  for (std::size_t g = 0; g < groups_; ++g)
    PairBlockKernels::pick(context_.rows->plan.kind_of(row_slots[16 * g]),
                           context_.columns->plan.kind_of(column_slots[16 * g]),
                           [&]<std::uint16_t row_kind, ColumnKind column_kind>() {
                             PairBlockKernels::list<row_kind, column_kind>(*this, g, used[g]);
                           });
  collect_survivors();
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
    append_lanes(alive, &store.plan.item[slot], &end_item_[at]);
    at += static_cast<std::size_t>(__builtin_popcount(alive));
  }
  if (at == 0) return;
  for (auto* v : {&end_x_, &end_y_, &end_z_}) std::fill_n(v->begin() + at, 15, (*v)[at - 1]);
  std::fill_n(end_item_.begin() + at, 15, end_item_[at - 1]);
}

}  // namespace lumirank::transport
