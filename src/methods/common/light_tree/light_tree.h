// A binary tree over the columns of a matrix: every cut through it is a clustering (Walter et al. 2005,
// sections 3 and 4). Columns that send light in different ways, or belong to different groups, are in trees
// of their own: a forest.
//
// Built from the top: a node is split in two where Σ intensity·(diagonal² + c²·(1 - cos)²) of the halves is
// least (section 3.1's measure of a cluster), of 16 places along each of six axes, places and directions.
// Deviations: Walter et al. merge nearest pairs from the bottom, which is O(n²) or a heap over everything.
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

  // Deterministic in the seed (it chooses representatives), whatever the number of threads. Columns that emit
  // nothing are left out. The matrix must outlive the tree. About 110 bytes per column. InternalError beyond
  // 2²⁷ columns.
  LightTree(const matrix::LightingMatrix& matrix, std::uint64_t seed);

  // The whole forest: a cut of these nodes is the coarsest.
  std::span<const Node> roots() const { return roots_; }
  std::size_t leaves() const { return order_.size(); }
  bool is_leaf(Node node) const { return node >= kLeaf; }
  // Of inner nodes.
  Node left(Node node) const {
    const Inner& n = nodes_[node];
    return n.left_size == 1 ? kLeaf | n.begin : node + 1;
  }
  Node right(Node node) const {
    const Inner& n = nodes_[node];
    return n.end - n.begin - n.left_size == 1 ? kLeaf | (n.end - 1) : node + n.left_size;
  }
  Node parent(Node node) const;  // kNone at a root
  // Its columns: a stretch of order(), of at least one.
  std::span<const matrix::Index> columns(Node node) const;
  std::span<const matrix::Index> order() const { return order_; }
  // What bounds need to know. Of a leaf it is asked of the matrix.
  matrix::ColumnSet set(Node node) const;
  // Σ over its columns of ColumnFeatures::emitted and of its luminance-like scalar.
  Rgb emitted(Node node) const;
  float power(Node node) const;
  std::uint64_t seed() const { return seed_; }
  // Drawn among its columns in proportion to power, by a tournament from the leaves up: a child has the
  // representative of its parent where it can (so that refining evaluates one new column, not two).
  matrix::Index representative(Node node) const;
  // The representative scaled per channel to the emission of the whole node; where one of its channels is
  // (nearly) black, by the scalar.
  matrix::ScaledColumn scaled(Node node) const;
  // The same for another of its columns, drawn in proportion to power as well, but so that no decision about
  // a cut has evaluated it: a second representative, for which a child's is its parent's where it can be,
  // too. For the same key it is the same wherever a cut has the node, so what it errs by has no edges.
  matrix::ScaledColumn redrawn(Node node, std::uint64_t key) const;

  std::size_t memory_bytes() const;
  // Of one column.
  Rgb emitted_of(matrix::Index j) const;
  float power_of(matrix::Index j) const;
  // What a column is scaled by to stand for so much emission, per channel; where one of its channels is
  // (nearly) black, by the scalar.
  Rgb scale_to(Rgb emission, matrix::Index j) const;

 private:
  matrix::ScaledColumn scaled_to(Node node, matrix::Index j) const;

  static constexpr Node kLeaf = 0x80000000u;  // kLeaf | place in order_
  // Inner nodes stand in the order of a walk that visits a node, its left side, its right side; so a subtree
  // of k leaves is k - 1 nodes in a row, and children need no numbers. 96 bytes.
  struct Inner {
    Bounds3f box;
    matrix::Cone cone;
    Rgb intensity, ceiling, emitted;
    std::uint32_t begin, end;
    std::uint32_t left_size : 27, emission : 2, spherical : 1, direct : 1;
    Node parent;
    matrix::Index representative;
  };
  // What spheres and rays are beside.
  struct Extent {
    float max_radius = 0, min_radius = 0, min_length = 0;
    std::int16_t medium = -1;
  };
  struct Builder;

  // Of an inner node: the luminance of `emitted`, which where emissions are unknown is the power in all
  // channels.
  static float power_of(Rgb emitted) { return luminance(emitted); }

  std::uint64_t seed_;
  const matrix::LightingMatrix& matrix_;
  matrix::ColumnFeatures features_;
  std::vector<Inner> nodes_;
  std::vector<Extent> extents_;  // by inner node, where columns are spherical or rays; else empty
  std::vector<matrix::Index> order_;
  std::vector<Node> leaf_parent_;  // by place
  std::vector<Node> roots_;
};

}  // namespace lumirank::methods
