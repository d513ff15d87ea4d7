#include "base/neighbor_distance.h"

#include <numeric>

#include "base/parallel.h"
#include "base/point_tree.h"

namespace lumirank {

std::vector<Neighbor> neighbors(std::span<const Vec3f> points, std::span<const std::uint32_t> group, int k) {
  std::vector<Neighbor> result(points.size());
  if (points.size() < 2) return result;
  std::vector<std::uint32_t> own;
  if (group.empty()) {
    own.resize(points.size());
    std::iota(own.begin(), own.end(), 0u);
    group = own;
  }
  const PointTree tree(points, group);
  parallel_for(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result[i] = tree.kth_of_others(points[i], group[i], k);
  });
  return result;
}

}  // namespace lumirank
