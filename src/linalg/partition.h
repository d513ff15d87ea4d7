// A partition of points into clusters: a permutation of point indices, cut into ranges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linalg/points.h"

namespace lumirank::linalg {

struct Partition {
  std::vector<std::uint32_t> order;   // point indices; not every point need be in it
  std::vector<std::uint32_t> starts;  // cluster k is order[starts[k] … starts[k+1]); one more than clusters

  std::size_t clusters() const { return starts.empty() ? 0 : starts.size() - 1; }
  std::span<const std::uint32_t> members(std::size_t k) const {
    return {order.data() + starts[k], order.data() + starts[k + 1]};
  }
};

// One cluster per group that has members, groups in ascending order. groups: one per point, or empty (all in
// one group).
Partition partition_by_group(std::span<const std::uint32_t> members, std::span<const std::uint16_t> groups);

// The expected squared error of representing the cluster by one member drawn in proportion to its norm (Hašan
// 2007, section 3.4 and appendix A): Σ_{i,j} (‖x_i‖‖x_j‖ − x_i·x_j) over ordered pairs, which is (Σ‖x‖)² −
// ‖Σx‖².
double cluster_cost(const Points& points, std::span<const double> norms,
                    std::span<const std::uint32_t> members);
double total_cost(const Points& points, std::span<const double> norms, const Partition& partition);

}  // namespace lumirank::linalg
