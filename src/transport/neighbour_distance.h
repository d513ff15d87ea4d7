// Distances to the k-th nearest neighbour among many points.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"

namespace lumirank::transport {

// Squared distance from each point to its k-th nearest other one (k ≥ 1; at most points.size() - 1 is used,
// and with a single point the result is 0). Exact; O(n log n) by a k-d tree; parallel.
std::vector<float> neighbour_distance_squared(std::span<const Vec3f> points, int k);

}  // namespace lumirank::transport
