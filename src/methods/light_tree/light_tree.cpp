#include "methods/light_tree/light_tree.h"

#include <algorithm>
#include <map>

#include "base/random.h"

namespace lumirank::methods {

using matrix::ColumnSet;
using matrix::Emission;
using matrix::Index;

// Halves each stretch at the median of its longest side, places and directions alike.
struct LightTree::Builder {
  LightTree& tree;
  std::uint64_t seed;
  std::vector<ColumnSet> sets;  // by column
  float scale = 1;              // of directions beside places

  float coordinate(Index j, int axis) const {
    const ColumnSet& set = sets[j];
    return axis < 3 ? set.box.center()[axis] : scale * set.cone.axis[axis - 3];
  }

  Node build(std::uint32_t begin, std::uint32_t end) {
    if (end - begin == 1) return kLeaf | begin;
    const auto stretch = std::span(tree.order_).subspan(begin, end - begin);
    int longest = 0;
    float width = -1;
    for (int axis = 0; axis < 6; ++axis) {
      float lo = kInfinity, hi = -kInfinity;
      for (const Index j : stretch) {
        const float x = coordinate(j, axis);
        lo = std::min(lo, x), hi = std::max(hi, x);
      }
      if (hi - lo > width) width = hi - lo, longest = axis;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(stretch.begin(), stretch.begin() + (middle - begin), stretch.end(),
                     [&](Index a, Index b) {
                       const float x = coordinate(a, longest), y = coordinate(b, longest);
                       return x != y ? x < y : a < b;
                     });
    const auto node = static_cast<Node>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    const Node left = build(begin, middle), right = build(middle, end);
    Inner inner;
    inner.set = join(tree.set(left), tree.set(right));
    inner.emitted = tree.emitted(left) + tree.emitted(right);
    inner.power = tree.power(left) + tree.power(right);
    inner.left = left, inner.right = right, inner.begin = begin, inner.end = end;
    const double u = unit_double(hash_ids(seed, Stage::representatives, node));
    inner.representative = tree.representative(u * inner.power < tree.power(left) ? left : right);
    for (const Node child : {left, right})
      (tree.is_leaf(child) ? tree.leaf_parent_[child ^ kLeaf] : tree.nodes_[child].parent) = node;
    tree.nodes_[node] = inner;
    return node;
  }
};

LightTree::LightTree(const matrix::LightingMatrix& matrix, std::uint64_t seed)
    : matrix_(matrix), features_(matrix.column_features()) {
  const std::size_t n = matrix.columns();
  Builder builder{*this, seed, std::vector<ColumnSet>(n)};
  Bounds3f all;
  std::map<std::tuple<std::uint16_t, Emission, bool>, std::vector<Index>> kinds;
  for (std::size_t j = 0; j < n; ++j) {
    const auto column = static_cast<Index>(j);
    builder.sets[j] = matrix.column_set(column);
    const ColumnSet& set = builder.sets[j];
    if (is_black(set.intensity)) continue;
    all.extend(set.box);
    kinds[{features_.group.empty() ? std::uint16_t{0} : features_.group[j], set.emission, set.spherical}]
        .push_back(column);
  }
  builder.scale = std::max(all.radius(), 1e-30f);
  for (const auto& [kind, columns] : kinds) order_.insert(order_.end(), columns.begin(), columns.end());
  leaf_parent_.assign(order_.size(), kNone);
  nodes_.reserve(order_.size());
  std::uint32_t begin = 0;
  for (const auto& [kind, columns] : kinds) {
    const auto end = begin + static_cast<std::uint32_t>(columns.size());
    roots_.push_back(builder.build(begin, end));
    begin = end;
  }
}

Rgb LightTree::emitted_of(Index j) const {
  return features_.emitted.empty() ? Rgb(power_of(j)) : features_.emitted[j];
}
float LightTree::power_of(Index j) const {
  if (!features_.emitted.empty()) return luminance(features_.emitted[j]);
  return features_.power.empty() ? mean(matrix_.column_set(j).intensity) : features_.power[j];
}

LightTree::Node LightTree::parent(Node node) const {
  return is_leaf(node) ? leaf_parent_[node ^ kLeaf] : nodes_[node].parent;
}
std::span<const Index> LightTree::columns(Node node) const {
  if (is_leaf(node)) return std::span(order_).subspan(node ^ kLeaf, 1);
  return std::span(order_).subspan(nodes_[node].begin, nodes_[node].end - nodes_[node].begin);
}
ColumnSet LightTree::set(Node node) const {
  return is_leaf(node) ? matrix_.column_set(order_[node ^ kLeaf]) : nodes_[node].set;
}
Rgb LightTree::emitted(Node node) const {
  return is_leaf(node) ? emitted_of(order_[node ^ kLeaf]) : nodes_[node].emitted;
}
float LightTree::power(Node node) const {
  return is_leaf(node) ? power_of(order_[node ^ kLeaf]) : nodes_[node].power;
}
Index LightTree::representative(Node node) const {
  return is_leaf(node) ? order_[node ^ kLeaf] : nodes_[node].representative;
}

matrix::ScaledColumn LightTree::scaled(Node node) const {
  const Index j = representative(node);
  if (is_leaf(node)) return {j, Rgb(1)};
  const Rgb whole = nodes_[node].emitted, own = emitted_of(j);
  const float scalar = nodes_[node].power / std::max(power_of(j), 1e-30f);
  Rgb scale;
  for (int c = 0; c < 3; ++c) {
    const float ratio = whole[c] / std::max(own[c], 1e-30f);
    scale[c] = ratio <= 4 * scalar ? ratio : scalar;
  }
  return {j, scale};
}

}  // namespace lumirank::methods
