// A binary tree over columns for adaptive sampling (Huo et al. 2016, section 5): what it needs of a node is a
// few of its columns, drawn in proportion to power. Unlike the light tree of cuts it needs no bounds.
//
// Columns that are in a tree already (ColumnFeatures::branch) keep it; what has the same branch, and all
// other columns, are divided by place and direction as in the light tree. These two kinds have roots of their
// own.
//
// Every node has `draws` columns, drawn with replacement. The k-th of a node is the first to arrive in a race
// of all its columns, and the k-th of its parent is one of its children's: half of what a node needs is known
// from above, and slices that have the same node draw the same columns, so that what these err by has no
// edges between slices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "matrix/lighting_matrix.h"
#include "methods/common/light_tree/split.h"

namespace lumirank::methods {

class ColumnTree {
 public:
  using Node = std::uint32_t;
  struct Root {
    Node node;
    bool given;  // of columns that came with their branches
  };

  // Columns without power are left out. Deterministic in the seed, whatever the number of threads.
  ColumnTree(const matrix::LightingMatrix& matrix, std::size_t draws, std::uint64_t seed);
  // Draws anew.
  void draw(std::uint64_t seed);

  std::span<const Root> roots() const { return roots_; }
  std::size_t draws() const { return draws_; }
  // A node that is not divided has at most as many columns as are drawn.
  bool is_leaf(Node node) const { return nodes_[node].right == 0; }
  Node left(Node node) const { return node + 1; }
  Node right(Node node) const { return nodes_[node].right; }
  std::span<const matrix::Index> columns(Node node) const {
    return {order_.data() + nodes_[node].begin, order_.data() + nodes_[node].end};
  }
  std::span<const matrix::Index> drawn(Node node) const { return {drawn_.data() + node * draws_, draws_}; }
  double power(Node node) const { return nodes_[node].power; }
  double power_of(matrix::Index j) const {
    return features_.power.empty() ? 1.0 : static_cast<double>(features_.power[j]);
  }
  std::size_t memory_bytes() const;

 private:
  struct Inner {
    std::uint32_t begin, end;
    Node right = 0;  // 0: not divided
    double power = 0;
  };
  struct Builder;
  void race(Node node);
  double arrival(matrix::Index j, std::size_t draw) const;

  matrix::ColumnFeatures features_;
  std::size_t draws_;
  std::uint64_t seed_ = 0;
  std::vector<Inner> nodes_;  // a node before its children, the left one at once after it
  std::vector<matrix::Index> order_, drawn_;
  std::vector<Root> roots_;
};

}  // namespace lumirank::methods
