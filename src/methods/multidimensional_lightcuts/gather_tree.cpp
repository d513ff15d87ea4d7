#include "methods/multidimensional_lightcuts/gather_tree.h"

#include <algorithm>

#include "base/random.h"
#include "methods/multidimensional_lightcuts/race.h"

namespace lumirank::methods {

using matrix::Index;

GatherTree::GatherTree(const matrix::LightingMatrix& matrix, std::uint64_t seed, float scale)
    : matrix_(matrix), features_(matrix.row_features()), seed_(seed), scale_(scale) {}

float GatherTree::coordinate(Index row, int axis) const {
  if (axis < 3) return features_.position.empty() ? 0.0f : features_.position[row][axis];
  return features_.normal.empty() ? 0.0f : 0.5f * scale_ * features_.normal[row][axis - 3];
}

int GatherTree::longest_side(const Inner& n) const {
  int longest = 0;
  float width = -1;
  for (int axis = 0; axis < 6; ++axis) {
    float lo = kInfinity, hi = -kInfinity;
    for (std::uint32_t k = n.begin; k < n.end; ++k) {
      const float x = coordinate(order_[k], axis);
      lo = std::min(lo, x), hi = std::max(hi, x);
    }
    if (hi - lo > width) width = hi - lo, longest = axis;
  }
  return longest;
}

void GatherTree::measure(Node node) {
  Inner& n = nodes_[node];
  Bounds3f box;
  matrix::Cone cone;
  for (std::uint32_t k = n.begin; k < n.end; ++k) {
    const Index row = order_[k];
    n.weight += features_.weight.empty() ? 1.0f : features_.weight[row];
    if (!features_.position.empty()) box.extend(features_.position[row]);
    if (features_.normal.empty()) continue;
    const matrix::Cone own{features_.normal[row], 1};
    cone = k == n.begin ? own : join(cone, own);
  }
  const float turn = features_.normal.empty() ? 0.0f : scale_ * (1 - cone.cosine);
  n.extent = (features_.position.empty() ? 0.0f : length_squared(box.diagonal())) + turn * turn;
}

float GatherTree::extent(const matrix::ColumnSet& set) const {
  const float turn = set.emission == matrix::Emission::omni ? 0.0f : scale_ * (1 - set.cone.cosine);
  const bool placed = set.emission != matrix::Emission::directional && !set.box.empty();
  return (placed ? length_squared(set.box.diagonal()) : 0.0f) + turn * turn;
}

void GatherTree::build(std::span<const Index> rows) {
  order_.assign(rows.begin(), rows.end());
  nodes_.clear();
  parts_.clear();
  key_ = matrix::id_of(features_.id, rows.front());
  nodes_.push_back({0, 0, static_cast<std::uint32_t>(rows.size()), 0, 0, 0, false});
  for (Node node = 0; node < nodes_.size(); ++node) {
    measure(node);
    const Inner n = nodes_[node];
    if (n.end - n.begin < 2) {
      nodes_[node].representative = n.begin;
      continue;
    }
    const int axis = longest_side(n);
    const std::uint32_t middle = n.begin + (n.end - n.begin) / 2;
    const auto at = [&](std::uint32_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(n.begin), at(middle), at(n.end), [&](Index a, Index b) {
      const float x = coordinate(a, axis), y = coordinate(b, axis);
      return x != y ? x < y : a < b;
    });
    nodes_[node].left = static_cast<Node>(nodes_.size());
    nodes_.push_back({0, n.begin, middle, 0, 0, 0, false});
    nodes_.push_back({0, middle, n.end, 0, 0, 0, false});
  }
  if (!features_.instant.empty())
    for (Node node = 0; node < nodes_.size(); ++node) part_by_instants(node);
  // A tournament from the leaves up.
  for (Node node = static_cast<Node>(nodes_.size()); node-- > 0;) {
    if (is_leaf(node)) continue;
    const double u = unit_double(hash_ids(seed_, Stage::representatives, key_, node));
    const Node l = left(node);
    const bool first = u * static_cast<double>(weight(node)) < static_cast<double>(weight(l));
    nodes_[node].representative = nodes_[first ? l : l + 1].representative;
  }
}

void GatherTree::part_by_instants(Node node) {
  Inner& n = nodes_[node];
  n.first_part = static_cast<std::uint32_t>(parts_.size());
  for (std::uint32_t k = n.begin; k < n.end; ++k) {
    const Index row = order_[k];
    const std::uint16_t instant = features_.instant[row];
    const auto begin = parts_.begin() + n.first_part;
    auto at = std::find_if(begin, parts_.end(), [&](const Part& p) { return p.instant >= instant; });
    const float weight = features_.weight.empty() ? 1.0f : features_.weight[row];
    const float turn =
        race_turn(hash_ids(seed_, Stage::representatives, matrix::id_of(features_.id, row), 1), weight);
    if (at == parts_.end() || at->instant != instant) {
      parts_.insert(at, {instant, 1, k, weight, turn});
      continue;
    }
    ++at->rows;
    at->weight += weight;
    if (turn < at->turn) at->turn = turn, at->representative = k;
  }
  n.parts = static_cast<std::uint32_t>(parts_.size()) - n.first_part;
}

const matrix::RowBounds& GatherTree::bounds(Node node) {
  while (bounds_.size() <= node) bounds_.push_back(matrix_.row_bounds());
  Inner& n = nodes_[node];
  if (!n.bounds_set) {
    bounds_[node]->set_rows(std::span<const Index>(order_).subspan(n.begin, n.end - n.begin));
    n.bounds_set = true;
  }
  return *bounds_[node];
}

}  // namespace lumirank::methods
