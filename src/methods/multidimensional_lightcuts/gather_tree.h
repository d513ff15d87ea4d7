// A binary tree over the receivers of a pixel (Walter et al. 2006, section 3.1).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/bounds.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

// Made anew for one pixel after the other; keeps its buffers. One thread at a time.
class GatherTree {
 public:
  using Node = std::uint32_t;

  // `scale`: how far apart in place counts as much as opposite normals.
  GatherTree(const matrix::LightingMatrix& matrix, std::uint64_t seed, float scale);

  // At least one row.
  void build(std::span<const matrix::Index> rows);

  static constexpr Node root() { return 0; }
  bool is_leaf(Node node) const { return nodes_[node].left == 0; }
  Node left(Node node) const { return nodes_[node].left; }
  Node right(Node node) const { return nodes_[node].left + 1; }
  // Rows below, as places in order().
  std::uint32_t begin(Node node) const { return nodes_[node].begin; }
  std::uint32_t end(Node node) const { return nodes_[node].end; }
  std::span<const matrix::Index> order() const { return order_; }
  // Σ of the rows' weights in the picture.
  float weight(Node node) const { return nodes_[node].weight; }
  // Place of the node's representative, drawn in proportion to weight; a child has its parent's where it can.
  std::uint32_t representative(Node node) const { return nodes_[node].representative; }
  // (diagonal of the places)² + scale² (1 − cosine of the normals' cone)²: what keeps nodes apart in light
  // trees, too (Walter et al. 2005, equation 4), but for the intensity.
  float extent(Node node) const { return nodes_[node].extent; }
  float extent(const matrix::ColumnSet& set) const;
  // Of all its rows.
  const matrix::RowBounds& bounds(Node node);

 private:
  struct Inner {
    Node left = 0;  // right follows; 0: a leaf
    std::uint32_t begin = 0, end = 0, representative = 0;
    float weight = 0, extent = 0;
    bool bounds_set = false;
  };
  void measure(Node node);
  // The longest of the six sides, places before normals.
  int longest_side(const Inner& n) const;
  float coordinate(matrix::Index row, int axis) const;

  const matrix::LightingMatrix& matrix_;
  matrix::RowFeatures features_;
  std::uint64_t seed_;
  float scale_;
  std::vector<matrix::Index> order_;
  std::vector<Inner> nodes_;
  std::vector<std::unique_ptr<matrix::RowBounds>> bounds_;
};

}  // namespace lumirank::methods
