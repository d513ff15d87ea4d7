// Entries and blocks of a SceneMatrix: pairs in any order, sorted into groups of one class.
#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "transport/scene_matrix_impl.h"

namespace lumirank::transport {

using matrix::Index;
using matrix::Part;

namespace {

constexpr std::size_t kPiece = 4096;  // pairs per task

// Pairs by number, evaluated together; entry k of the piece goes to out(k).
class PairList {
 public:
  explicit PairList(const PairContext& context) : context_(context) {}

  void add(Index i, Index j) {
    const std::uint32_t row = context_.rows->plan.slot[i], column = context_.columns->plan.slot[j];
    const std::uint32_t kinds = static_cast<std::uint32_t>(context_.rows->plan.kind_of(row)) << 16 |
                                context_.columns->plan.kind_of(column);
    pairs_.push_back({kinds, row, column, static_cast<std::uint32_t>(pairs_.size())});
  }

  template <typename Out>
  Tally evaluate(PairBlock& block, Part part, Out&& out) {
    std::stable_sort(pairs_.begin(), pairs_.end(),
                     [](const Pair& a, const Pair& b) { return a.kinds < b.kinds; });
    for (std::size_t k = 0; k < pairs_.size();) {
      std::uint32_t used = 0;
      const std::uint32_t kinds = pairs_[k].kinds;
      for (int lane = 0; lane < kLanes; ++lane) {
        const bool more = k < pairs_.size() && pairs_[k].kinds == kinds;
        const Pair& pair = pairs_[more ? k : k - 1];
        rows_.push_back(pair.row), columns_.push_back(pair.column);
        numbers_.push_back(more ? pair.number : kNoItem);
        if (more) used |= 1u << lane, ++k;
      }
      used_.push_back(static_cast<std::uint16_t>(used));
    }
    block.set_list(rows_, columns_, used_);
    const Tally tally = finish(block, part, pairs_.size());
    copy_out(block, part, numbers_, out);
    return tally;
  }

 private:
  struct Pair {
    std::uint32_t kinds, row, column, number;
  };
  const PairContext& context_;
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> rows_, columns_, numbers_;
  std::vector<std::uint16_t> used_;
};

}  // namespace

void SceneMatrix::entries(std::span<const Index> row_ids, std::span<const Index> column_ids,
                          std::span<Rgb> out, Part part) const {
  if (row_ids.size() != column_ids.size() || out.size() != row_ids.size())
    throw InternalError("transport::SceneMatrix::entries: rows, columns and out differ in length");
  const Tally tally = parallel_sum(row_ids.size(), kPiece, Tally{}, [&](std::size_t begin, std::size_t end) {
    PairList list(impl_->context);
    for (std::size_t k = begin; k < end; ++k) list.add(row_ids[k], column_ids[k]);
    Impl::Lease block(*impl_);
    return list.evaluate(*block, part, [&](std::uint32_t k) -> Rgb& { return out[begin + k]; });
  });
  impl_->account(counters(), tally);
}

void SceneMatrix::block(std::span<const Index> row_ids, std::span<const Index> column_ids, std::span<Rgb> out,
                        Part part) const {
  if (out.size() != row_ids.size() * column_ids.size())
    throw InternalError("transport::SceneMatrix::block: out is not rows × columns");
  // Along the longer side, so that rays of a packet share an end.
  const bool by_column = row_ids.size() >= column_ids.size();
  const std::size_t across = by_column ? row_ids.size() : column_ids.size();
  const Tally tally = parallel_sum(out.size(), kPiece, Tally{}, [&](std::size_t begin, std::size_t end) {
    const auto place = [&](std::size_t k) {
      const std::size_t line = k / across, along = k % across;
      return by_column ? std::pair(along, line) : std::pair(line, along);
    };
    PairList list(impl_->context);
    for (std::size_t k = begin; k < end; ++k) list.add(row_ids[place(k).first], column_ids[place(k).second]);
    Impl::Lease block(*impl_);
    return list.evaluate(*block, part, [&](std::uint32_t k) -> Rgb& {
      const auto [a, b] = place(begin + k);
      return out[a * column_ids.size() + b];
    });
  });
  impl_->account(counters(), tally);
}

}  // namespace lumirank::transport
