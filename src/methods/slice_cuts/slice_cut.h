// Clusters of lights of a slice's reduced matrix: first a cut by bounds, then splitting by the greatest
// contribution (Huo et al. 2015, section 4.2 and algorithm 1).
//
// Where we deviate: the paper splits node after node and takes the contributions of the neighbors of each
// anew; here all clusters above the threshold are split together, then all contributions and the threshold
// are taken anew, until nothing is above it. The result does not depend on an order, and costs O(log) rounds.
// The rows that equation 7 takes its maximum over are those that `entries` was started with: some of the
// slice's, for a maximum over all is often that of one pixel beside a light (SliceColumns::choose).
#pragma once

#include <span>
#include <vector>

#include "matrix/entry_bounds.h"
#include "methods/common/light_tree/light_tree.h"
#include "methods/slice_cuts/settings.h"
#include "methods/slice_cuts/slice_entries.h"

namespace lumirank::methods {

class SliceCut {
 public:
  static constexpr std::uint32_t kNoSlot = 0xffffffffu;
  struct Cluster {
    LightTree::Node node;
    std::uint32_t slot;  // of its representative; kNoSlot: it is not evaluated
    matrix::ScaledColumn column;
    // Of its members at some rows, with visibility: greatest entry over power. < 0: not sampled yet.
    float lit = -1;
  };

  SliceCut(const LightTree& tree, const matrix::LightingMatrix& matrix)
      : tree_(tree), bounds_(matrix.row_bounds()) {}

  // Evaluates representatives in `entries`, as far as it takes, and samples them for sparse visibility.
  void choose(const SliceCutSettings& settings, SliceEntries& entries);
  // Other representatives of the clusters that were chosen, of drawing 1, 2, … below settings.drawings.
  void redraw(const SliceCutSettings& settings, std::uint64_t drawing);
  // In the order of the tree: neighbors are near.
  std::span<const Cluster> clusters() const { return clusters_; }
  // What the cut by bounds took of the last choose().
  double seconds_of_bounds() const { return seconds_of_bounds_; }

 private:
  void initial_cut(std::size_t count, std::span<const matrix::Index> receivers);
  void add_slots(const SliceCutSettings& settings, SliceEntries& entries);
  void sample_members(const SliceCutSettings& settings, SliceEntries& entries);
  void contributions(const SliceCutSettings& settings, SliceEntries& entries);
  bool split(const SliceCutSettings& settings, SliceEntries& entries);
  std::uint32_t place(LightTree::Node node) const;

  struct Bounded {
    float bound, power;
    LightTree::Node node;
  };

  const LightTree& tree_;
  std::unique_ptr<matrix::RowBounds> bounds_;
  std::vector<Bounded> heap_;
  std::vector<Cluster> clusters_, next_;
  double seconds_of_bounds_ = 0;
  std::vector<float> max_entry_;     // M·G: greatest entry over power, by cluster
  std::vector<float> contribution_;  // Γ, by cluster
  std::vector<std::uint32_t> member_rows_, member_cluster_;
  std::vector<matrix::Index> members_;
  std::vector<float> member_light_;
  std::vector<std::uint32_t> candidates_;  // clusters above the threshold
};

}  // namespace lumirank::methods
