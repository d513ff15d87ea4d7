// Entries of a SceneMatrix for one thread: a slice's receivers are copied together once, so that each column
// then meets them as it meets a tile of neighbors.
#include <algorithm>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "matrix/entry_reader.h"
#include "transport/cpu/pair_list.h"
#include "transport/cpu/scene_matrix_impl.h"

namespace lumirank::transport {

using matrix::Cost;
using matrix::Index;
using matrix::Part;

namespace {

class SceneReader final : public matrix::EntryReader {
 public:
  explicit SceneReader(const PairContext& context)
      : context_(context),
        slice_context_(context),
        column_block_(slice_context_),
        slice_list_block_(slice_context_),
        list_block_(context_),
        slice_list_(slice_context_),
        list_(context_) {
    slice_context_.rows = &slice_;
  }

  void set_rows(std::span<const Index> rows) override {
    const RowStore& all = *context_.rows;
    const auto kind = [&](std::uint32_t place) { return all.plan.kind_of(all.plan.slot[rows[place]]); };
    order_.resize(rows.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return kind(a) != kind(b) ? kind(a) < kind(b) : a < b;
    });
    TilePlan& plan = slice_.plan;
    plan.runs.clear(), plan.item.clear(), plan.kind.clear(), places_.clear(), slice_.groups.clear();
    slice_.key.clear(), slice_.two_sided.clear();
    rows_ = rows.size();
    for (std::size_t k = 0; k < order_.size();) {
      const std::uint16_t run_kind = kind(order_[k]);
      TilePlan::Run run{static_cast<std::uint32_t>(plan.item.size()), 0, run_kind};
      for (; k < order_.size() && kind(order_[k]) == run_kind; ++k)
        plan.item.push_back(rows[order_[k]]), places_.push_back(order_[k]);
      run.end = static_cast<std::uint32_t>((plan.item.size() + 15) / 16 * 16);
      plan.item.resize(run.end, kNoItem), places_.resize(run.end, kNoItem);
      plan.runs.push_back(run);
      plan.kind.resize(run.end / 16, run_kind);
    }
    in_order_ = plan.runs.size() < 2;
    plan.slot.resize(rows_);
    for (std::uint32_t slot = 0; slot < places_.size(); ++slot)
      if (places_[slot] != kNoItem) plan.slot[places_[slot]] = slot;
    plan.first_run = {0, static_cast<std::uint32_t>(plan.runs.size())};
    copy_rows(all);
    if (rows_ > 0) column_block_.set_row_tile(0);
  }

  Cost column(Index j, std::span<Rgb> out, Part part) override {
    if (j >= context_.columns->plan.slot.size() || out.size() != rows_)
      throw InternalError(
          "transport::SceneReader::column needs a column of the matrix and room for its rows");
    if (rows_ == 0) return {};
    column_block_.set_column(context_.columns->plan.slot[j]);
    const Cost cost = finish(column_block_, part, rows_);
    copy_out(column_block_, part, places_, [&](std::uint32_t to) -> Rgb& { return out[to]; });
    return with_loss(context_, cost);
  }

  Cost unoccluded_scalars(Index j, Rgb weights, std::span<float> out) override {
    const Cost cost = evaluate(j, out.size());
    if (in_order_) {
      column_block_.scalars(weights, [&](std::size_t group, const float* lanes) {
        std::copy_n(lanes, std::min<std::size_t>(16, out.size() - 16 * group), &out[16 * group]);
      });
      return cost;
    }
    column_block_.scalars(weights, [&](std::size_t group, const float* lanes) {
      const std::uint32_t* const to = &places_[16 * group];
      for (std::size_t k = 0; k < 16; ++k)
        if (to[k] != kNoItem) out[to[k]] = lanes[k];
    });
    return cost;
  }

  Cost add_unoccluded(std::span<const matrix::ScaledColumn> columns, std::span<const float> shares,
                      std::span<const std::uint32_t> of, std::span<Rgb> sums) override {
    Cost cost;
    if (columns.empty() || rows_ == 0) return cost;
    if (shares.size() % columns.size() != 0 || of.size() != rows_ || sums.size() != rows_)
      throw InternalError("add_unoccluded: as many shares for every column, and one of them for every row");
    const std::size_t each = shares.size() / columns.size();
    share_of_.assign(places_.size(), 0);
    sums_.assign(3 * places_.size(), 0.0f);
    for (std::size_t slot = 0; slot < places_.size(); ++slot)
      if (places_[slot] != kNoItem) share_of_[slot] = of[places_[slot]];
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto share = shares.subspan(k * each, each);
      if (std::ranges::all_of(share, [](float s) { return s == 0; })) continue;
      cost += evaluate(columns[k].column, rows_);
      column_block_.add_shares(columns[k].scale, share, share_of_, sums_);
    }
    for (std::size_t slot = 0; slot < places_.size(); ++slot) {
      const float* const sum = &sums_[48 * (slot / 16) + slot % 16];
      if (places_[slot] != kNoItem) sums[places_[slot]] += Rgb(sum[0], sum[16], sum[32]);
    }
    return cost;
  }

  Cost entries_at(std::span<const std::uint32_t> places, std::span<const Index> columns, std::span<Rgb> out,
                  Part part) override {
    return list_entries(slice_list_, slice_list_block_, slice_.plan.slot, {places, columns, out}, part);
  }
  Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
               Part part) override {
    return list_entries(list_, list_block_, context_.rows->plan.slot, {rows, columns, out}, part);
  }

 private:
  // E of a column, into its block.
  Cost evaluate(Index j, std::size_t rows) {
    if (j >= context_.columns->plan.slot.size() || rows != rows_)
      throw InternalError(
          "transport::SceneReader::column needs a column of the matrix and room for its rows");
    if (rows_ == 0) return {};
    column_block_.set_column(context_.columns->plan.slot[j]);
    return finish(column_block_, Part::unoccluded, rows_);
  }

  static constexpr std::size_t kPiece = 4096;  // pairs whose buffers stay in a core's own cache

  struct Asked {
    std::span<const std::uint32_t> rows;
    std::span<const Index> columns;
    std::span<Rgb> out;
  };
  // row_slots: of what `rows` counts.
  Cost list_entries(PairList& list, PairBlock& block, std::span<const std::uint32_t> row_slots,
                    const Asked& asked, Part part) {
    Cost cost;
    if (asked.rows.size() != asked.columns.size() || asked.out.size() != asked.rows.size())
      throw InternalError("transport::SceneReader: rows, columns and out of a list differ in length");
    const std::vector<std::uint32_t>& column_slots = context_.columns->plan.slot;
    for (std::size_t begin = 0; begin < asked.rows.size(); begin += kPiece) {
      list.clear();
      const std::size_t end = std::min(asked.rows.size(), begin + kPiece);
      for (std::size_t k = begin; k < end; ++k)
        list.add(row_slots[asked.rows[k]], column_slots[asked.columns[k]]);
      cost += list.evaluate(block, part, [&](std::uint32_t k) -> Rgb& { return asked.out[begin + k]; });
    }
    return with_loss(context_, cost);
  }

  void copy_rows(const RowStore& all) {
    const std::vector<std::uint32_t>& items = slice_.plan.item;
    slice_.groups.resize(items.size() / 16);
    const auto slot_of = [&](std::size_t k) { return all.plan.slot[items[k]]; };
    for (std::size_t g = 0; g < slice_.groups.size(); ++g) {
      std::uint32_t slots[16], last = 0;
      // The first of a group is never padding, the others repeat the last.
      for (std::size_t k = 0; k < 16; ++k)
        slots[k] = last = items[16 * g + k] == kNoItem ? last : slot_of(16 * g + k);
      all.gather(slots, slice_.groups[g]);
      for (int k = 0; k < 16; ++k)
        if (items[16 * g + static_cast<std::size_t>(k)] == kNoItem)
          slice_.groups[g].depth_max[k] = -kInfinity;
    }
    copy_by_slot(all.key, slice_.key, slot_of);
    copy_by_slot(all.two_sided, slice_.two_sided, slot_of);
  }
  template <typename T, typename SlotOf>
  void copy_by_slot(const std::vector<T>& from, std::vector<T>& to, SlotOf&& slot_of) {
    if (from.empty()) return;
    to.assign(slice_.plan.item.size(), T{0});
    for (std::size_t k = 0; k < to.size(); ++k)
      if (slice_.plan.item[k] != kNoItem) to[k] = from[slot_of(k)];
  }

  const PairContext& context_;
  RowStore slice_;
  PairContext slice_context_;
  PairBlock column_block_, slice_list_block_, list_block_;
  PairList slice_list_, list_;
  std::size_t rows_ = 0;
  bool in_order_ = true;  // rows lie as they were given
  std::vector<std::uint32_t> order_, places_, share_of_;
  std::vector<float> sums_;  // 16 × r, g, b by group
};

}  // namespace

std::unique_ptr<matrix::EntryReader> SceneMatrix::reader() const {
  return std::make_unique<SceneReader>(impl_->context);
}

}  // namespace lumirank::transport
