// A binary tree over columns for adaptive sampling (Huo et al. 2016, section 5). Unlike the light tree of
// cuts it needs no bounds: what it knows of a node is where its columns are and their power.
//
// Columns that are in a tree already (ColumnFeatures::branch) keep it; what has the same branch, and all
// other columns, are divided by place and direction as in the light tree. These two kinds have roots of their
// own.
//
// Columns are drawn for a slice of rows by walks down the tree, on which a child is chosen in proportion to
// its power over the square of its distance from the slice. The paper draws in proportion to power alone: of
// a node around the slice the few columns next to it, which bring most of its light, are then seldom drawn,
// and a node of which none was drawn seems to be known (docs/participating-media.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/bounds.h"
#include "base/random.h"
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
  // Of a node's columns one, and the probability with which it was drawn among them.
  struct Drawn {
    std::uint32_t place;  // in the order of the tree
    double probability;
  };
  // Where the rows are for which columns are drawn.
  struct Place {
    Vec3f center;
    float radius = 0;
  };

  // Columns without power are left out. A node with at most `leaf` columns is not divided. Deterministic.
  ColumnTree(const matrix::LightingMatrix& matrix, std::size_t leaf);

  std::span<const Root> roots() const { return roots_; }
  bool is_leaf(Node node) const { return nodes_[node].right == 0; }
  Node left(Node node) const { return node + 1; }
  Node right(Node node) const { return nodes_[node].right; }
  std::span<const matrix::Index> columns(Node node) const {
    return {order_.data() + nodes_[node].begin, order_.data() + nodes_[node].end};
  }
  // Whether a place is among the columns of the node.
  bool holds(Node node, std::uint32_t place) const {
    return place >= nodes_[node].begin && place < nodes_[node].end;
  }
  matrix::Index column(std::uint32_t place) const { return order_[place]; }
  Drawn draw(Node node, const Place& from, Rng& rng) const;
  // Of an inner node, that a walk goes to the left.
  double left_probability(Node node, const Place& from) const;
  double power(Node node) const { return nodes_[node].power; }
  std::size_t memory_bytes() const;

 private:
  struct Inner {
    std::uint32_t begin, end;
    Node right = 0;  // 0: not divided
    double power = 0;
    Bounds3f box{};
  };
  struct Builder;
  double power_of(matrix::Index j) const {
    return features_.power.empty() ? 1.0 : static_cast<double>(features_.power[j]);
  }
  Vec3f place_of(matrix::Index j) const;

  matrix::ColumnFeatures features_;
  std::size_t leaf_;
  std::vector<Inner> nodes_;  // a node before its children, the left one at once after it
  std::vector<matrix::Index> order_;
  std::vector<Root> roots_;
};

}  // namespace lumirank::methods
