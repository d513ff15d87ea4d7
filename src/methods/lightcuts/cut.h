// A cut through the light tree for one receiver, refined where its bound is greatest (Walter et al. 2005,
// sections 3.1 and 4.2). Refinement goes in rounds, each of which asks for several entries at once, so that
// the matrix can evaluate them side by side.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "matrix/entry_bounds.h"
#include "matrix/entry_reader.h"
#include "methods/common/light_tree/light_tree.h"

namespace lumirank::methods {

struct CutLimits {
  double error_bound = 0.02;     // a node is refined while its bound exceeds this share of the total
  std::size_t max_nodes = 1000;  // of a cut
  // Nodes refined in one round. They are those that refining one after another would take first, as far as
  // the round's own entries do not change the order.
  std::size_t per_round = 8;
};

// What a cut is made of, and every node above it: a tree of its own, the roots first. Children follow their
// parent.
struct CutNode {
  LightTree::Node node = 0;
  std::uint32_t children = 0;  // the first of two neighbors; 0: on the cut
  Rgb entry;                   // of the representative, not scaled
  float value = 0;             // luminance of scale × entry
};

class Cut {
 public:
  Cut(const LightTree& tree, const CutLimits& limits) : tree_(tree), limits_(limits) {}

  void use(const CutLimits& limits) { limits_ = limits; }
  // Begins anew, with the tree's roots. `bounds` holds this row and must live until the cut is finished.
  void begin(matrix::Index row, const matrix::RowBounds& bounds);
  // Appends the columns whose entries in the row are needed next; false: none are, the cut is finished.
  bool request(std::vector<matrix::Index>& columns);
  // Their values, in the same order.
  void take(std::span<const Rgb> values);

  matrix::Index row() const { return row_; }
  std::span<const CutNode> nodes() const { return nodes_; }
  // Nodes on the cut.
  std::size_t size() const { return size_; }
  // Σ scale × entry over the cut.
  Rgb total() const;
  // Bounds that were computed.
  std::size_t bounds_computed() const { return bounds_computed_; }

 private:
  struct Waiting {
    float bound;
    std::uint32_t place;  // in nodes_
  };
  static bool later(const Waiting& a, const Waiting& b) {
    return a.bound != b.bound ? a.bound < b.bound : a.place > b.place;
  }
  float threshold() const;
  void add(std::uint32_t place);
  void wait(std::uint32_t place);
  bool wake();

  const LightTree& tree_;
  CutLimits limits_;
  const matrix::RowBounds* bounds_ = nullptr;
  bool begun_ = false;  // the roots' entries were asked for
  matrix::Index row_ = 0;
  std::vector<CutNode> nodes_;
  std::vector<std::uint32_t> asked_, refined_;  // places in nodes_, of the round
  std::vector<Waiting> heap_, asleep_;          // asleep: bound far below what is refined at present
  float max_asleep_ = 0;
  std::size_t size_ = 0, bounds_computed_ = 0;
  double total_ = 0;  // luminance
};

// Finishes cuts that have begun, side by side: a round of all of them is one list of entries.
class CutRounds {
 public:
  void finish(std::span<Cut> cuts, matrix::EntryReader& reader);

  double seconds_entries() const { return seconds_entries_; }
  double seconds_cuts() const { return seconds_cuts_; }
  std::uint64_t entries() const { return entries_; }

 private:
  std::vector<matrix::Index> rows_, columns_;
  std::vector<std::uint32_t> places_;
  std::vector<Rgb> values_;
  std::vector<std::uint32_t> ends_;
  double seconds_entries_ = 0, seconds_cuts_ = 0;
  std::uint64_t entries_ = 0;
};

}  // namespace lumirank::methods
