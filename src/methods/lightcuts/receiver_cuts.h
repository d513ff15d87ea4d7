// Finished cuts of some receivers, several side by side.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "matrix/entry_reader.h"
#include "methods/lightcuts/cut.h"

namespace lumirank::methods {

class ReceiverCuts {
 public:
  // Side by side: neighbors, which ask for like entries, so that rays and lanes find company.
  static constexpr std::size_t kTogether = 8;

  ReceiverCuts(const matrix::LightingMatrix& matrix, const LightTree& tree, const CutLimits& limits) {
    for (std::size_t k = 0; k < kTogether; ++k) {
      bounds_.push_back(matrix.row_bounds());
      cuts_.emplace_back(tree, limits);
    }
  }

  void limit(const CutLimits& limits) {
    for (Cut& cut : cuts_) cut.use(limits);
  }
  // Calls use(k, cut) for the cut of rows[k], in order.
  template <typename Use>
  void cut(std::span<const matrix::Index> rows, matrix::EntryReader& reader, Use&& use) {
    for (std::size_t begin = 0; begin < rows.size(); begin += kTogether) {
      const std::size_t count = std::min(kTogether, rows.size() - begin);
      for (std::size_t k = 0; k < count; ++k) {
        bounds_[k]->set_rows(rows.subspan(begin + k, 1));
        cuts_[k].begin(rows[begin + k], *bounds_[k]);
      }
      rounds_.finish(std::span(cuts_).first(count), reader);
      for (std::size_t k = 0; k < count; ++k) {
        const Cut& done = cuts_[k];
        ++cuts_made_, nodes_ += done.size(), bounds_computed_ += done.bounds_computed();
        max_nodes_ = std::max<std::uint64_t>(max_nodes_, done.size());
        use(begin + k, done);
      }
    }
  }

  std::uint64_t cuts_made() const { return cuts_made_; }
  std::uint64_t nodes() const { return nodes_; }
  std::uint64_t max_nodes() const { return max_nodes_; }
  std::uint64_t bounds_computed() const { return bounds_computed_; }
  const CutRounds& rounds() const { return rounds_; }

 private:
  std::vector<std::unique_ptr<matrix::RowBounds>> bounds_;  // one for each cut at hand
  std::vector<Cut> cuts_;
  CutRounds rounds_;
  std::uint64_t cuts_made_ = 0, nodes_ = 0, max_nodes_ = 0, bounds_computed_ = 0;
};

}  // namespace lumirank::methods
