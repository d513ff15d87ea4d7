// Cuts of fixed size for one receiver, and walks from a node of the cut down to one of its columns.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "matrix/entry_bounds.h"
#include "methods/light_tree/light_tree.h"

namespace lumirank::methods {

// A column drawn for a node: entry / probability is the node's sum on average.
struct DrawnColumn {
  matrix::Index column;
  float probability;
};

class LightWalk {
 public:
  explicit LightWalk(const LightTree& tree) : tree_(tree) {}

  // Begins anew at the roots. `bounds` holds the row and must live until the row is done.
  void begin(const matrix::RowBounds& bounds);
  // Splits the node with the greatest bound until there are `nodes` of them or none has a bound above
  // `threshold` (luminance). Nodes that cannot send anything are not on the cut.
  void refine(std::size_t nodes, float threshold);
  // On the cut.
  std::size_t size() const { return heap_.size() + leaves_.size(); }
  // Appends one column for each node of the cut, or none where the walk comes to nodes that send nothing.
  // random(): the next number in [0, 1).
  template <typename Random>
  void draw(Random&& random, std::vector<DrawnColumn>& drawn) {
    for (const LightTree::Node leaf : leaves_) drawn.push_back({tree_.representative(leaf), 1});
    for (const Waiting& w : heap_) walk(w.node, random(), drawn);
  }
  std::uint64_t bounds_computed() const { return bounds_computed_; }

 private:
  struct Waiting {
    float bound;
    LightTree::Node node;
  };
  static bool later(const Waiting& a, const Waiting& b) {
    return a.bound != b.bound ? a.bound < b.bound : a.node > b.node;
  }
  // Luminances: guesses from the nearest and from the farthest point of a node.
  struct Weights {
    float near, far, apart;  // apart: without distances
  };
  Weights weigh(LightTree::Node node);
  void add(LightTree::Node node);
  void walk(LightTree::Node node, double u, std::vector<DrawnColumn>& drawn);

  const LightTree& tree_;
  const matrix::RowBounds* bounds_ = nullptr;
  std::vector<Waiting> heap_;
  std::vector<LightTree::Node> leaves_;
  std::uint64_t bounds_computed_ = 0;
};

}  // namespace lumirank::methods
