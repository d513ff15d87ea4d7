#include "linalg/partition.h"

#include <algorithm>

#include "base/parallel.h"

namespace lumirank::linalg {

Partition partition_by_group(std::span<const std::uint32_t> members, std::span<const std::uint16_t> groups) {
  Partition p;
  p.order.assign(members.begin(), members.end());
  p.starts.push_back(0);
  if (p.order.empty()) return p;
  if (!groups.empty()) {
    std::stable_sort(p.order.begin(), p.order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return groups[a] < groups[b]; });
    for (std::size_t k = 1; k < p.order.size(); ++k)
      if (groups[p.order[k]] != groups[p.order[k - 1]]) p.starts.push_back(static_cast<std::uint32_t>(k));
  }
  p.starts.push_back(static_cast<std::uint32_t>(p.order.size()));
  return p;
}

double cluster_cost(const Points& points, std::span<const double> norms,
                    std::span<const std::uint32_t> members) {
  if (members.size() < 2) return 0;
  PointSum sum(points.dimension);
  PointReader reader(points);
  for (std::uint32_t j : members) sum.add(reader[j], norms[j]);
  return std::max(0.0, sum.weight * sum.weight - sum.squared_length());
}

double total_cost(const Points& points, std::span<const double> norms, const Partition& partition) {
  return parallel_sum(partition.clusters(), 8, 0.0, [&](std::size_t begin, std::size_t end) {
    double s = 0;
    for (std::size_t k = begin; k < end; ++k) s += cluster_cost(points, norms, partition.members(k));
    return s;
  });
}

}  // namespace lumirank::linalg
