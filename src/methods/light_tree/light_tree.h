// A binary tree over the columns of a matrix: every cut through it is a clustering (Walter et al. 2005,
// sections 3 and 4). Columns that send light in different ways, or belong to different groups, are in trees
// of their own: a forest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "matrix/entry_bounds.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

class LightTree {
 public:
  using Node = std::uint32_t;
  static constexpr Node kNone = 0xffffffffu;

  // Deterministic in the seed (it chooses representatives). Columns that emit nothing are left out. The
  // matrix must outlive the tree.
  LightTree(const matrix::LightingMatrix& matrix, std::uint64_t seed);

  // The whole forest: a cut of these nodes is the coarsest.
  std::span<const Node> roots() const { return roots_; }
  std::size_t leaves() const { return order_.size(); }
  bool is_leaf(Node node) const { return node >= kLeaf; }
  // Of inner nodes.
  Node left(Node node) const { return nodes_[node].left; }
  Node right(Node node) const { return nodes_[node].right; }
  Node parent(Node node) const;  // kNone at a root
  // Its columns: a stretch of order(), of at least one.
  std::span<const matrix::Index> columns(Node node) const;
  std::span<const matrix::Index> order() const { return order_; }
  // What bounds need to know.
  matrix::ColumnSet set(Node node) const;
  // Σ over its columns of ColumnFeatures::emitted and of its luminance-like scalar.
  Rgb emitted(Node node) const;
  float power(Node node) const;
  // Drawn among its columns in proportion to power, by a tournament from the leaves up: a child has the
  // representative of its parent where it can (so that refining evaluates one new column, not two).
  matrix::Index representative(Node node) const;
  // The representative scaled per channel to the emission of the whole node; where one of its channels is
  // (nearly) black, by the scalar.
  matrix::ScaledColumn scaled(Node node) const;

 private:
  static constexpr Node kLeaf = 0x80000000u;  // kLeaf | place in order_
  struct Inner {
    matrix::ColumnSet set;
    Rgb emitted;
    float power = 0;
    Node left = kNone, right = kNone, parent = kNone;
    std::uint32_t begin = 0, end = 0;
    matrix::Index representative = 0;
  };
  struct Builder;

  Rgb emitted_of(matrix::Index j) const;
  float power_of(matrix::Index j) const;

  const matrix::LightingMatrix& matrix_;
  matrix::ColumnFeatures features_;
  std::vector<Inner> nodes_;
  std::vector<matrix::Index> order_;
  std::vector<Node> leaf_parent_;  // by place
  std::vector<Node> roots_;
};

}  // namespace lumirank::methods
