// A binary tree over columns for adaptive sampling (Huo et al. 2016, section 5). Unlike the light tree of
// cuts it needs no bounds: what it knows of a node is where its columns are and their power.
//
// Columns that are in a tree already (ColumnFeatures::branch) keep it; what has the same branch, and all
// other columns, are divided by place and direction as in the light tree. These two kinds have roots of their
// own.
//
// The tree also knows how near a node is to a slice of rows, as walks down the tree need it
// (column_draws.h).
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

  // Columns without power are left out, and of emitters the strong_emitters(). A node with at
  // most `leaf` columns is not divided. `cut`: nodes of the coarse cut, about. Deterministic.
  ColumnTree(const matrix::LightingMatrix& matrix, std::size_t leaf, std::size_t cut = 2048);

  std::span<const Root> roots() const { return roots_; }
  // Columns with more than a 256th of the power of all emitters: in no node, since all rows of a slice can
  // afford them. In media places of their own make them noise that no other column foretells.
  std::span<const matrix::Index> strong_emitters() const { return strong_emitters_; }
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
  double power(Node node) const { return nodes_[node].power; }

  // Walks in proportion to power over the square of the distance: one of a node's columns, and, of an inner
  // node, the probability of going to the left.
  Drawn draw_by_nearness(Node node, const Place& from, Rng& rng) const;
  double left_by_nearness(Node node, const Place& from) const;
  // The same by other probabilities of going to the left, in a leaf by power and distance.
  template <typename Left>
  Drawn walk(Node node, const Place& from, Rng& rng, Left&& left_probability) const {
    double probability = 1;
    while (!is_leaf(node)) {
      const double to_left = left_probability(node);
      const bool goes_left = rng.next_double() < to_left;
      probability *= goes_left ? to_left : 1 - to_left;
      node = goes_left ? left(node) : right(node);
    }
    const Drawn last = draw_in_leaf(node, from, rng);
    return {last.place, probability * last.probability};
  }

  // Nodes of much power that have all columns below them, each once, and those above: parents before their
  // children.
  struct Coarse {
    Node node;
    bool divided;  // not of the cut itself
  };
  std::span<const Node> coarse_cut() const { return cut_; }
  std::span<const Coarse> coarse_nodes() const { return coarse_; }
  static constexpr std::uint32_t kFine = 0xffffffff;
  // By node: its number among coarse_nodes(), or kFine.
  std::uint32_t coarse(Node node) const { return coarse_of_[node]; }
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
  Drawn draw_in_leaf(Node leaf, const Place& from, Rng& rng) const;
  void make_coarse(std::size_t cut);

  matrix::ColumnFeatures features_;
  std::size_t leaf_;
  std::vector<Inner> nodes_;  // a node before its children, the left one at once after it
  std::vector<matrix::Index> order_;
  std::vector<Root> roots_;
  std::vector<matrix::Index> strong_emitters_;
  std::vector<Node> cut_;
  std::vector<Coarse> coarse_;
  std::vector<std::uint32_t> coarse_of_;
};

}  // namespace lumirank::methods
