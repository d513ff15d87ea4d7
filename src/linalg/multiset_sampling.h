// Clustering by sampling (Hašan 2007, section 3.5): centers drawn in proportion to the cost of their edges,
// then every point to the nearest center.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linalg/partition.h"

namespace lumirank::linalg {

// α_i = Σ_j d(x_i, x_j) over the points of the same cluster of `groups`, in the order of groups.order;
// rounding to 0.
std::vector<double> edge_costs(const Points& points, std::span<const double> norms, const Partition& groups);

// Distinct points (positions in groups.order, ascending) with their multiset weights Σ 1/p.
struct Centers {
  std::vector<std::uint32_t> position;
  std::vector<double> weight;
};
// Draws until `count` are distinct, or no more can be found: when all α are 0, when no undrawn α remains, or
// after 64·count draws (what is left is then so improbable that splitting finds it cheaper).
Centers draw_centers(std::span<const double> alpha, std::size_t count, std::uint64_t seed);

// Every point goes to the center k of its own group with the least w_k·(‖k‖‖x‖ − k·x); of equals, the first.
// A group without a center stays one cluster; centers that get no point (their direction is another center's)
// make none.
Partition assign_to_centers(const Points& points, std::span<const double> norms, const Partition& groups,
                            const Centers& centers);

}  // namespace lumirank::linalg
