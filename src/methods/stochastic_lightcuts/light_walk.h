// Cuts of fixed size for one receiver, and walks from a node of the cut down to one of its columns.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "matrix/entry_bounds.h"
#include "methods/common/light_tree/light_tree.h"

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
  // Splits the most urgent node until there are `nodes` of them or none has a bound above `threshold`
  // (luminance). Urgent is not what has the greatest bound, as in Yuksel's, but what probably adds the most
  // noise: √(near · far) is nearer to what a node sends than its bound, which next to it is large and rests
  // on few columns; many columns are seen in part. Of ten such rules the best in two rooms: a third less
  // error. Nodes that cannot send anything are not on the cut.
  void refine(std::size_t nodes, float threshold);
  // On the cut.
  std::size_t size() const { return heap_.size() + settled_.size(); }
  // Appends one column for each node of the cut, or none where the walk comes to nodes that send nothing.
  // random(): the next number in [0, 1).
  template <typename Random>
  void draw(Random&& random, std::vector<DrawnColumn>& drawn) {
    for (const LightTree::Node node : settled_) walk(node, random(), drawn);
    for (const Waiting& w : heap_) walk(w.node, random(), drawn);
  }
  std::uint64_t bounds_computed() const { return bounds_computed_; }

 private:
  struct Waiting {
    float urgency, bound;
    LightTree::Node node;
  };
  static bool later(const Waiting& a, const Waiting& b) {
    return a.urgency != b.urgency ? a.urgency < b.urgency : a.node > b.node;
  }
  // Luminances: guesses from the nearest and from the farthest point of a node.
  struct Weights {
    float near, far, apart;  // apart: without distances
    bool small;              // so small and far that all below it looks alike but for its intensity
  };
  Weights weigh(LightTree::Node node);
  double share_of_left(LightTree::Node node, bool& left_small, bool& right_small);
  void add(LightTree::Node node);
  void walk(LightTree::Node node, double u, std::vector<DrawnColumn>& drawn);

  const LightTree& tree_;
  const matrix::RowBounds* bounds_ = nullptr;
  std::vector<Waiting> heap_;
  std::vector<LightTree::Node> settled_;  // on the cut, and not to be split
  std::uint64_t bounds_computed_ = 0;
};

}  // namespace lumirank::methods
