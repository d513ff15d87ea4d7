#include "methods/common/light_tree/light_tree.h"

#include <algorithm>

#include "base/random.h"

namespace lumirank::methods {

using matrix::ColumnSet;
using matrix::Index;

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
  if (is_leaf(node)) return matrix_.column_set(order_[node ^ kLeaf]);
  const Inner& n = nodes_[node];
  ColumnSet set;
  set.emission = static_cast<matrix::Emission>(n.emission);
  set.spherical = n.spherical, set.direct = n.direct;
  set.box = n.box, set.cone = n.cone, set.intensity = n.intensity, set.ceiling = n.ceiling;
  if (!extents_.empty()) {
    const Extent& extent = extents_[node];
    set.radius = extent.max_radius, set.min_radius = extent.min_radius;
    set.min_length = extent.min_length, set.medium = extent.medium;
  }
  return set;
}
Rgb LightTree::emitted(Node node) const {
  return is_leaf(node) ? emitted_of(order_[node ^ kLeaf]) : nodes_[node].emitted;
}
float LightTree::power(Node node) const {
  return is_leaf(node) ? power_of(order_[node ^ kLeaf]) : power_of(nodes_[node].emitted);
}
Index LightTree::representative(Node node) const {
  return is_leaf(node) ? order_[node ^ kLeaf] : nodes_[node].representative;
}

matrix::ScaledColumn LightTree::scaled(Node node) const { return scaled_to(node, representative(node)); }

matrix::ScaledColumn LightTree::redrawn(Node node, std::uint64_t key) const {
  Node at = node;
  while (!is_leaf(at)) {
    const auto l = static_cast<double>(power(left(at))), r = static_cast<double>(power(right(at)));
    const double p = l + r > 0 ? l / (l + r) : 0.5;
    at = unit_double(hash_ids(key, Stage::representatives, at)) < p ? left(at) : right(at);
  }
  return scaled_to(node, representative(at));
}

matrix::ScaledColumn LightTree::scaled_to(Node node, Index j) const {
  if (is_leaf(node)) return {j, Rgb(1)};
  return {j, scale_to(nodes_[node].emitted, j)};
}

Rgb LightTree::scale_to(Rgb whole, Index j) const {
  const Rgb own = emitted_of(j);
  const float scalar = power_of(whole) / std::max(power_of(j), 1e-30f);
  Rgb scale;
  for (int c = 0; c < 3; ++c) {
    const float ratio = whole[c] / std::max(own[c], 1e-30f);
    scale[c] = ratio <= 4 * scalar ? ratio : scalar;
  }
  return scale;
}

std::size_t LightTree::memory_bytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(nodes_) + bytes(extents_) + bytes(order_) + bytes(leaf_parent_) + bytes(roots_);
}

}  // namespace lumirank::methods
