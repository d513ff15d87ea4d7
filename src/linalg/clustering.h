// The two clusterings of Hašan 2007, section 3.5, and their combination.
#pragma once

#include <cstdint>
#include <span>

#include "linalg/partition.h"
#include "linalg/splitting.h"

namespace lumirank::linalg {

enum class ClusteringAlgorithm {
  combined,  // two thirds of the clusters (two fifths of many) by sampling, the rest by splitting these
  sampling,
  splitting,
};

struct ClusteringSettings {
  ClusteringAlgorithm algorithm = ClusteringAlgorithm::combined;
  std::size_t clusters = 100;
  std::uint64_t seed = 1;
};

// Clusters `members` without ever joining two groups (groups: one per point, or empty). There are at least as
// many clusters as groups, and fewer than asked for only when all costs are zero or, by sampling, centers
// coincide. The result can be split on. References to points and norms must outlive it.
Splitter cluster(const Points& points, std::span<const double> norms, std::span<const std::uint32_t> members,
                 std::span<const std::uint16_t> groups, const ClusteringSettings& settings);

}  // namespace lumirank::linalg
