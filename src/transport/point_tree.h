// Neighbours among many points.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/vec.h"

namespace lumirank::transport {

// A balanced k-d tree: node n splits its range of points at the middle, children are 2n + 1 and 2n + 2, so
// only the splitting planes are stored. Built in parallel; O(n log n).
class PointTree {
 public:
  explicit PointTree(std::span<const Vec3f> points);

  // The k-th smallest squared distance from `p` to a point (k ≥ 1, at most the number of points), exact.
  float kth_distance_squared(Vec3f p, int k) const;

 private:
  struct Query {
    Vec3f p;
    std::size_t wanted;
    std::vector<float> heap;
    bool full() const { return heap.size() == wanted; }
    void offer(float d2);
  };

  std::pair<std::size_t, std::size_t> range(int level, std::size_t k) const;
  void split(int level, std::size_t k, std::size_t node);
  void visit(int level, std::size_t k, std::size_t node, Vec3f off, Query& q) const;

  std::vector<Vec3f> points_;
  std::vector<std::uint8_t> axis_;
  std::vector<float> split_;
  int levels_;
};

}  // namespace lumirank::transport
