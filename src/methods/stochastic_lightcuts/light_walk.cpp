#include "methods/stochastic_lightcuts/light_walk.h"

#include <algorithm>
#include <cmath>

namespace lumirank::methods {

using Node = LightTree::Node;

namespace {

// What an infinite bound counts as; far above any finite one of use.
constexpr float kUnboundedStep = 1e30f;

// A node is small where its nearest and its farthest point differ by so much in what distance makes of them,
// and its directions by no more than that: at 1.2, a quarter fewer bounds and no measurable noise.
constexpr float kSmall = 1.2f, kNarrow = 0.9f;

// The share of the first of two weights, none of them negative and not both 0.
double share(float first, float second) {
  if (std::isinf(first)) return 1;
  if (std::isinf(second)) return 0;
  return static_cast<double>(first) / (static_cast<double>(first) + static_cast<double>(second));
}

}  // namespace

void LightWalk::begin(const matrix::RowBounds& bounds) {
  bounds_ = &bounds;
  heap_.clear(), settled_.clear();
  for (const Node root : tree_.roots()) add(root);
}

void LightWalk::add(Node node) {
  const Weights w = weigh(node);
  if (!(w.near > 0)) return;
  if (tree_.is_leaf(node)) return settled_.push_back(node);
  const auto columns = static_cast<float>(tree_.columns(node).size());
  heap_.push_back({std::sqrt(std::min(w.near, kUnboundedStep)) * std::sqrt(w.far * columns), w.near, node});
  std::push_heap(heap_.begin(), heap_.end(), later);
}

void LightWalk::refine(std::size_t nodes, float threshold) {
  while (!heap_.empty() && size() < nodes) {
    const Waiting top = heap_.front();
    std::pop_heap(heap_.begin(), heap_.end(), later);
    heap_.pop_back();
    if (top.bound > threshold) {
      add(tree_.left(top.node)), add(tree_.right(top.node));
    } else {
      settled_.push_back(top.node);
    }
  }
}

LightWalk::Weights LightWalk::weigh(Node node) {
  const matrix::ColumnSet set = tree_.set(node);
  const matrix::BoundParts parts = bounds_->parts(set);
  ++bounds_computed_;
  Rgb near, far;
  for (int c = 0; c < 3; ++c) {
    const bool black = !(parts.reflected[c] > 0);
    near[c] = black ? 0.0f : std::min(parts.reflected[c] * parts.near, set.ceiling[c]);
    far[c] = black ? 0.0f : std::min(parts.reflected[c] * parts.far, set.ceiling[c]);
  }
  const bool narrow = set.emission == matrix::Emission::omni || set.cone.cosine > kNarrow;
  return {luminance(near), luminance(far), luminance(parts.reflected),
          narrow && parts.near <= kSmall * parts.far};
}

// After Yuksel 2019: the mean of the probabilities by the nearest and by the farthest points, since close to
// a node one alone tells little. Where both children may be infinitely close, distances tell nothing.
// Negative if neither sends anything.
double LightWalk::share_of_left(Node node, bool& left_small, bool& right_small) {
  const Weights left = weigh(tree_.left(node)), right = weigh(tree_.right(node));
  left_small = left.small, right_small = right.small;
  if (!(right.far > 0)) return left.far > 0 ? 1 : -1;
  if (!(left.far > 0)) return 0;
  const bool unknown = std::isinf(left.near) && std::isinf(right.near);
  return 0.5 * (share(left.far, right.far) +
                (unknown ? share(left.apart, right.apart) : share(left.near, right.near)));
}

void LightWalk::walk(Node node, double u, std::vector<DrawnColumn>& drawn) {
  double probability = 1;
  bool small = false;
  while (!tree_.is_leaf(node)) {
    bool left_small = true, right_small = true;
    const double first = small ? share(luminance(tree_.set(tree_.left(node)).intensity),
                                       luminance(tree_.set(tree_.right(node)).intensity))
                               : share_of_left(node, left_small, right_small);
    if (first < 0) return;
    if (u < first) {
      u /= first, probability *= first;
      node = tree_.left(node), small = left_small;
    } else {
      u = (u - first) / (1 - first), probability *= 1 - first;
      node = tree_.right(node), small = right_small;
    }
    u = std::min(u, 1 - 0x1p-53);
  }
  drawn.push_back({tree_.representative(node), static_cast<float>(probability)});
}

}  // namespace lumirank::methods
