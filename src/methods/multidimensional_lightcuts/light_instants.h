// What the nodes of a light tree have of each instant (Walter et al. 2006: a representative for every instant
// that a cluster has).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/common/light_tree/light_tree.h"

namespace lumirank::methods {

class LightInstants {
 public:
  // Columns of one instant. The representative is drawn in proportion to power, and is that of every node
  // below that has it.
  struct Part {
    std::uint16_t instant = 0;
    std::uint32_t columns = 0;
    matrix::Index representative = 0;
    float turn = 0;   // of the representative in the draw: the least of all
    float power = 0;  // luminance of `emitted`
    Rgb emitted{0};
    Rgb intensity{0}, ceiling{0};  // as of ColumnSet
  };

  // Of a matrix that tells its columns' instants; the tree must outlive it. About 400 bytes per column.
  LightInstants(const LightTree& tree, const matrix::LightingMatrix& matrix);

  // In the order of the instants, only those that the node has.
  std::span<const Part> parts(LightTree::Node node) const {
    if (tree_.is_leaf(node)) return std::span(of_column_).subspan(tree_.columns(node)[0], 1);
    return std::span(of_nodes_).subspan(stretch_[node].begin, stretch_[node].count);
  }

 private:
  void join_children(LightTree::Node node);

  const LightTree& tree_;
  struct Stretch {
    std::size_t begin = 0, count = 0;
  };
  std::vector<Stretch> stretch_;  // by inner node
  std::vector<Part> of_nodes_, of_column_;
};

}  // namespace lumirank::methods
