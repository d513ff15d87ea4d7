#include "emitters/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "emitters/light_split.h"

namespace lumirank::emitters {
namespace {

// Of so many lights the parts of a node are built side by side.
constexpr std::size_t kManyLights = 1 << 14;

}  // namespace

// What the children of a node are drawn by.
struct LightTree::Weights {
  float weight[kWidth];
  double sum = 0;

  Weights(const Node& node, const LitPoint& at) {
    node.extents.importance(at, weight);
    for (const float w : weight) sum += w;
    if (std::isfinite(sum)) return;
    // Intensities out of all measure: any chances are right that sample() and pmf() agree on.
    sum = 0;
    for (float& w : weight) w = w > 0 ? 1.0f : 0.0f, sum += w;
  }
};

LightTree::LightTree(std::span<const LightBound> lights) : leaf_of_(lights.size(), kNone) {
  std::vector<LightItem> items;
  for (std::size_t k = 0; k < lights.size(); ++k)
    if (lights[k].intensity > 0)
      items.push_back({lights[k], lights[k].bounds.center(), static_cast<std::uint32_t>(k)});
  if (items.empty()) return;
  build(items, nodes_);
  for (std::uint32_t slot = 0; slot < nodes_.size() * kWidth; ++slot) {
    const std::uint32_t child = nodes_[slot / kWidth].child[slot % kWidth];
    if (child == kNothing) continue;
    (child & kLeaf ? leaf_of_[child & ~kLeaf] : nodes_[child].parent) = slot;
  }
}

void LightTree::build(std::span<LightItem> items, std::vector<Node>& nodes) {
  const std::size_t at = nodes.size();
  nodes.emplace_back();
  // The largest part is divided until there are as many as a node can hold, or all of them fit into one node
  // each; of those, the ones that the free slots have room for are leaves of this node.
  std::span<LightItem> parts[kWidth] = {items};
  int count = 1;
  while (count < kWidth) {
    auto& largest =
        *std::max_element(parts, parts + count, [](auto a, auto b) { return a.size() < b.size(); });
    if (largest.size() <= kWidth) break;
    const std::size_t middle = split_lights(largest);
    parts[count++] = largest.subspan(middle);
    largest = largest.first(middle);
  }
  for (int k = 0; k < count; ++k) {
    const auto part = parts[k];
    if (part.size() < 2 || count - 1 + part.size() > kWidth) continue;
    parts[k] = part.first(1);
    for (std::size_t m = 1; m < part.size(); ++m) parts[count++] = part.subspan(m, 1);
  }
  std::array<std::vector<Node>, kWidth> apart;
  const bool many = items.size() >= kManyLights;
  parallel_for(static_cast<std::size_t>(many ? count : 0), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (parts[k].size() > 1) build(parts[k], apart[k]);
  });
  for (int k = 0; k < count; ++k) {
    nodes[at].extents.set(k, join_all(parts[k]));
    if (parts[k].size() == 1) {
      nodes[at].child[k] = kLeaf | parts[k][0].light;
      continue;
    }
    const auto first = static_cast<std::uint32_t>(nodes.size());
    nodes[at].child[k] = first;
    if (!many) {
      build(parts[k], nodes);
      continue;
    }
    // Its own nodes count from 0.
    for (Node& node : apart[static_cast<std::size_t>(k)]) {
      for (std::uint32_t& child : node.child)
        if (child != kNothing && !(child & kLeaf)) child += first;
      nodes.push_back(node);
    }
  }
}

bool LightTree::reaches(const LitPoint& at) const { return !empty() && Weights(nodes_[0], at).sum > 0; }

LightTree::Pick LightTree::sample(const LitPoint& at, double u) const {
  if (empty()) return {};
  double pmf = 1;
  std::uint32_t node = 0;
  while (true) {
    const Weights weights(nodes_[node], at);
    if (!(weights.sum > 0)) return {};
    double rest = u * weights.sum;
    int chosen = -1;
    for (int k = 0; k < kWidth; ++k) {
      if (!(weights.weight[k] > 0)) continue;
      chosen = k;  // the last one possible, should rounding lead past it
      if (rest < weights.weight[k]) break;
      rest -= weights.weight[k];
    }
    const double w = weights.weight[chosen];
    pmf *= w / weights.sum;
    const std::uint32_t child = nodes_[node].child[chosen];
    if (child & kLeaf) return {child & ~kLeaf, static_cast<float>(pmf)};
    u = std::min(rest / w, 0x1.fffffffffffffp-1);
    node = child;
  }
}

float LightTree::pmf(const LitPoint& at, std::uint32_t light) const {
  double pmf = 1;
  for (std::uint32_t slot = leaf_of_[light]; slot != kNone; slot = nodes_[slot / kWidth].parent) {
    const Weights weights(nodes_[slot / kWidth], at);
    const float w = weights.weight[slot % kWidth];
    if (!(w > 0)) return 0;
    pmf *= w / weights.sum;
  }
  return leaf_of_[light] == kNone ? 0.0f : static_cast<float>(pmf);
}

}  // namespace lumirank::emitters
