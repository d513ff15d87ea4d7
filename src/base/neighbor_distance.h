// Distances to the k-th nearest neighbor among many points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace lumirank {

struct Neighbor {
  float distance_squared = 0;
  int count = 0;  // which neighbor it is: k, or as many as there are
};

// From each point to the k-th nearest one that belongs to another group (k ≥ 1); `group` is empty (each point
// by itself) or has one number per point. How dense particles' lights lie is a question about particles: one
// that is caught in fur leaves ten lights within a millimeter, which say nothing about where other light is.
// Exact; O(n log n) by a k-d tree as long as groups are small; parallel.
std::vector<Neighbor> neighbors(std::span<const Vec3f> points, std::span<const std::uint32_t> group, int k);

}  // namespace lumirank
