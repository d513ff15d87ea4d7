// Pairs in any order, sorted into groups of one class. Inside this room only.
#pragma once

#include <cstdint>
#include <vector>

#include "transport/cpu/pair_block.h"

namespace lumirank::transport {

// Pairs by number, evaluated together; entry k of the list goes to out(k). Keeps its buffers for the next.
class PairList {
 public:
  explicit PairList(const PairContext& context) : context_(context) {}

  void clear() {
    pairs_.clear(), classes_.clear();
    rows_.clear(), columns_.clear(), numbers_.clear(), used_.clear();
  }
  // Slots on both sides.
  void add(std::uint32_t row, std::uint32_t column) {
    const std::uint32_t kinds = static_cast<std::uint32_t>(context_.rows->plan.kind_of(row)) << 16 |
                                context_.columns->plan.kind_of(column);
    const auto number = static_cast<std::uint32_t>(pairs_.size());
    Class& own = class_of(kinds);
    (own.first == kNoItem ? own.first : pairs_[own.last].next) = number;
    own.last = number;
    pairs_.push_back({row, column, kNoItem});
  }

  template <typename Out>
  matrix::Cost evaluate(PairBlock& block, matrix::Part part, Out&& out) {
    for (const Class& one : classes_) {
      std::uint32_t next = one.first, last = next;
      while (next != kNoItem) {
        std::uint32_t used = 0;
        for (int lane = 0; lane < kLanes; ++lane) {
          const Pair& pair = pairs_[next != kNoItem ? next : last];
          rows_.push_back(pair.row), columns_.push_back(pair.column), numbers_.push_back(next);
          if (next != kNoItem) used |= 1u << lane, last = next, next = pair.next;
        }
        used_.push_back(static_cast<std::uint16_t>(used));
      }
    }
    block.set_list(rows_, columns_, used_);
    const matrix::Cost cost = finish(block, part, pairs_.size());
    copy_out(block, part, numbers_, out);
    return cost;
  }

 private:
  // The pairs of a class are a chain in the order in which they came.
  struct Pair {
    std::uint32_t row, column, next;
  };
  struct Class {
    std::uint32_t kinds, first, last;
  };
  Class& class_of(std::uint32_t kinds) {
    // Pairs mostly come in stretches, and classes are few.
    if (latest_ >= classes_.size() || classes_[latest_].kinds != kinds) {
      latest_ = 0;
      while (latest_ < classes_.size() && classes_[latest_].kinds != kinds) ++latest_;
      if (latest_ == classes_.size()) classes_.push_back({kinds, kNoItem, kNoItem});
    }
    return classes_[latest_];
  }

  const PairContext& context_;
  std::vector<Pair> pairs_;
  std::vector<Class> classes_;  // in the order in which they came
  std::size_t latest_ = 0;
  std::vector<std::uint32_t> rows_, columns_, numbers_;
  std::vector<std::uint16_t> used_;
};

}  // namespace lumirank::transport
