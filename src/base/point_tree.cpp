#include "base/point_tree.h"

#include <algorithm>

#include "base/bounds.h"
#include "base/parallel.h"

namespace lumirank {
namespace {
constexpr std::uint32_t kLeaf = 16;
}

PointTree::PointTree(std::span<const Vec3f> points) : PointTree(points, {}) {}

PointTree::PointTree(std::span<const Vec3f> points, std::span<const std::uint32_t> group) {
  points_.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    points_.push_back({points[i], group.empty() ? kNoGroup - 1 : group[i]});
  std::size_t leaves = 1;
  levels_ = 0;
  while (points_.size() > leaves * kLeaf) leaves *= 2, ++levels_;
  axis_.resize(leaves - 1), split_.resize(leaves - 1);
  for (int level = 0; level < levels_; ++level) {
    const std::size_t first = (std::size_t{1} << level) - 1;
    parallel_for(std::size_t{1} << level, 1, [&](std::size_t k, std::size_t) { split(level, k, first + k); });
  }
}

float PointTree::kth_distance_squared(Vec3f p, int k) const {
  return kth_of_others(p, kNoGroup, k).distance_squared;
}

Neighbor PointTree::kth_of_others(Vec3f p, std::uint32_t group, int k) const {
  Query q{p, static_cast<std::size_t>(k), group, {}};
  q.heap.reserve(q.wanted);
  visit(0, 0, 0, Vec3f{}, q);
  if (q.heap.empty()) return {};
  return {q.heap.front(), static_cast<int>(q.heap.size())};
}

void PointTree::Query::offer(float d2) {
  if (!full()) {
    heap.push_back(d2);
    std::push_heap(heap.begin(), heap.end());
  } else if (d2 < heap.front()) {
    std::pop_heap(heap.begin(), heap.end());
    heap.back() = d2;
    std::push_heap(heap.begin(), heap.end());
  }
}

// Range of the k-th node of a level.
std::pair<std::size_t, std::size_t> PointTree::range(int level, std::size_t k) const {
  const auto edge = [&](std::size_t i) {
    return static_cast<std::size_t>((static_cast<unsigned long long>(points_.size()) * i) >> level);
  };
  return {edge(k), edge(k + 1)};
}

void PointTree::split(int level, std::size_t k, std::size_t node) {
  const auto [begin, end] = range(level, k);
  const std::size_t middle = range(level + 1, 2 * k).second;
  Bounds3f box;
  for (std::size_t i = begin; i < end; ++i) box.extend(points_[i].p);
  const Vec3f size = box.diagonal();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const Point& a, const Point& b) { return a.p[axis] < b.p[axis]; });
  axis_[node] = static_cast<std::uint8_t>(axis);
  split_[node] = points_[middle].p[axis];
}

// `off`: how far p is from the node's box, per axis (a lower bound).
void PointTree::visit(int level, std::size_t k, std::size_t node, Vec3f off, Query& q) const {
  if (level == levels_) {
    const auto [begin, end] = range(level, k);
    for (std::size_t i = begin; i < end; ++i)
      if (points_[i].group != q.without) q.offer(length_squared(points_[i].p - q.p));
    return;
  }
  const int axis = axis_[node];
  const float to_plane = q.p[axis] - split_[node];
  const std::size_t near = to_plane < 0 ? 0 : 1;
  visit(level + 1, 2 * k + near, 2 * node + 1 + near, off, q);
  off[axis] = to_plane;
  // Rounding may make the bound exceed a true distance by some ulps; the factor keeps the search exact.
  if (!q.full() || length_squared(off) * (1 - 1e-6f) <= q.heap.front())
    visit(level + 1, 2 * k + 1 - near, 2 * node + 2 - near, off, q);
}

}  // namespace lumirank
