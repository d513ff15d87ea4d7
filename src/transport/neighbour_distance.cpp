#include "transport/neighbour_distance.h"

#include <algorithm>

#include "base/parallel.h"
#include "transport/point_tree.h"

namespace lumirank::transport {

std::vector<float> neighbour_distance_squared(std::span<const Vec3f> points, int k) {
  std::vector<float> result(points.size(), 0.0f);
  if (points.size() < 2) return result;
  const int usable = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(k), points.size() - 1));
  const PointTree tree(points);
  parallel_for(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    // The point itself is among its neighbours.
    for (std::size_t i = begin; i < end; ++i) result[i] = tree.kth_distance_squared(points[i], usable + 1);
  });
  return result;
}

}  // namespace lumirank::transport
