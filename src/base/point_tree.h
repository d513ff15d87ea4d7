// Neighbors among many points.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/neighbor_distance.h"
#include "base/vec.h"

namespace lumirank {

// A balanced k-d tree: node n splits its range of points at the middle, children are 2n + 1 and 2n + 2, so
// only the splitting planes are stored. Built in parallel; O(n log n).
class PointTree {
 public:
  explicit PointTree(std::span<const Vec3f> points);
  // Points that belong to groups.
  PointTree(std::span<const Vec3f> points, std::span<const std::uint32_t> group);

  // The k-th smallest squared distance from `p` to a point (k ≥ 1, at most the number of points), exact.
  float kth_distance_squared(Vec3f p, int k) const;
  // The same among the points of other groups; the farthest of these if they are fewer.
  Neighbor kth_of_others(Vec3f p, std::uint32_t group, int k) const;

 private:
  struct Query {
    Vec3f p;
    std::size_t wanted;
    std::uint32_t without;  // points of this group do not count
    std::vector<float> heap;
    bool full() const { return heap.size() == wanted; }
    void offer(float d2);
  };

  std::pair<std::size_t, std::size_t> range(int level, std::size_t k) const;
  void split(int level, std::size_t k, std::size_t node);
  void visit(int level, std::size_t k, std::size_t node, Vec3f off, Query& q) const;

  static constexpr std::uint32_t kNoGroup = 0xffffffffu;
  struct Point {
    Vec3f p;
    std::uint32_t group;
  };

  std::vector<Point> points_;
  std::vector<std::uint8_t> axis_;
  std::vector<float> split_;
  int levels_;
};

}  // namespace lumirank
