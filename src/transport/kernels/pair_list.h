// Pairs in any order, sorted into groups of one class. Inside this room only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "transport/kernels/pair_block.h"

namespace lumirank::transport {

// Pairs by number, evaluated together; entry k of the list goes to out(k). Keeps its buffers for the next.
class PairList {
 public:
  explicit PairList(const PairContext& context) : context_(context) {}

  void clear() {
    pairs_.clear();
    rows_.clear(), columns_.clear(), numbers_.clear(), used_.clear();
  }
  void add(matrix::Index i, matrix::Index j) {
    const std::uint32_t row = context_.rows->plan.slot[i], column = context_.columns->plan.slot[j];
    const std::uint32_t kinds = static_cast<std::uint32_t>(context_.rows->plan.kind_of(row)) << 16 |
                                context_.columns->plan.kind_of(column);
    pairs_.push_back({kinds, row, column, static_cast<std::uint32_t>(pairs_.size())});
  }

  template <typename Out>
  Tally evaluate(PairBlock& block, matrix::Part part, Out&& out) {
    // By number among equals: the same as a stable sort, without its buffer.
    std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
      return a.kinds != b.kinds ? a.kinds < b.kinds : a.number < b.number;
    });
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

}  // namespace lumirank::transport
