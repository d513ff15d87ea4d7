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

  // Its rows by their instants, in the order of those; empty where rows have none. A part's representative is
  // drawn in proportion to weight, and is its child's where that has it.
  struct Part {
    std::uint16_t instant = 0;
    std::uint32_t rows = 0, representative = 0;  // a place
    float weight = 0;
    float turn = 0;  // of the representative in the draw: the least of all
  };
  std::span<const Part> parts(Node node) const {
    return std::span(parts_).subspan(nodes_[node].first_part, nodes_[node].parts);
  }
  std::uint16_t instant(std::uint32_t place) const { return features_.instant[order_[place]]; }
  // Whose random numbers the pixel uses.
  std::uint64_t key() const { return key_; }

 private:
  struct Inner {
    Node left = 0;  // right follows; 0: a leaf
    std::uint32_t begin = 0, end = 0, representative = 0;
    float weight = 0, extent = 0;
    bool bounds_set = false;
    std::uint32_t first_part = 0, parts = 0;
  };
  void measure(Node node);
  void part_by_instants(Node node);
  // The longest of the six sides, places before normals.
  int longest_side(const Inner& n) const;
  float coordinate(matrix::Index row, int axis) const;

  const matrix::LightingMatrix& matrix_;
  matrix::RowFeatures features_;
  std::uint64_t seed_;
  float scale_;
  std::vector<matrix::Index> order_;
  std::vector<Inner> nodes_;
  std::vector<Part> parts_;
  std::uint64_t key_ = 0;
  std::vector<std::unique_ptr<matrix::RowBounds>> bounds_;
};

}  // namespace lumirank::methods
