#include "methods/stochastic_lightcuts/light_walk.h"

#include <algorithm>
#include <cmath>

namespace lumirank::methods {

using Node = LightTree::Node;

namespace {

// Where nothing is known (infinite bounds), more power goes first; far above any finite bound of use.
constexpr float kUnknown = 1e30f;

// The share of the first of two weights, none of them negative and not both 0.
double share(float first, float second) {
  if (std::isinf(first)) return 1;
  if (std::isinf(second)) return 0;
  return static_cast<double>(first) / (static_cast<double>(first) + static_cast<double>(second));
}

}  // namespace

void LightWalk::begin(const matrix::RowBounds& bounds) {
  bounds_ = &bounds;
  heap_.clear(), leaves_.clear();
  for (const Node root : tree_.roots()) add(root);
}

void LightWalk::add(Node node) {
  const float bound = luminance(bounds_->bound(tree_.set(node)));
  ++bounds_computed_;
  if (!(bound > 0)) return;
  if (tree_.is_leaf(node)) return leaves_.push_back(node);
  heap_.push_back({bound < kUnknown ? bound : kUnknown * (1 + tree_.power(node)), node});
  std::push_heap(heap_.begin(), heap_.end(), later);
}

void LightWalk::refine(std::size_t nodes, float threshold) {
  while (!heap_.empty() && size() < nodes && heap_.front().bound > threshold) {
    const Node node = heap_.front().node;
    std::pop_heap(heap_.begin(), heap_.end(), later);
    heap_.pop_back();
    add(tree_.left(node)), add(tree_.right(node));
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
  return {luminance(near), luminance(far), luminance(parts.reflected)};
}

// Yuksel 2019, section 4.2: the mean of the probabilities by the nearest and by the farthest points, since
// close to a node one alone tells little. Where both children may be infinitely close, distances tell
// nothing.
void LightWalk::walk(Node node, double u, std::vector<DrawnColumn>& drawn) {
  double probability = 1;
  while (!tree_.is_leaf(node)) {
    const Weights left = weigh(tree_.left(node)), right = weigh(tree_.right(node));
    double first;
    if (!(right.far > 0)) {
      if (!(left.far > 0)) return;
      first = 1;
    } else if (!(left.far > 0)) {
      first = 0;
    } else {
      const bool unknown = std::isinf(left.near) && std::isinf(right.near);
      first = 0.5 * (share(left.far, right.far) +
                     (unknown ? share(left.apart, right.apart) : share(left.near, right.near)));
    }
    if (u < first) {
      u /= first, probability *= first;
      node = tree_.left(node);
    } else {
      u = (u - first) / (1 - first), probability *= 1 - first;
      node = tree_.right(node);
    }
    u = std::min(u, 1 - 0x1p-53);
  }
  drawn.push_back({tree_.representative(node), static_cast<float>(probability)});
}

}  // namespace lumirank::methods
