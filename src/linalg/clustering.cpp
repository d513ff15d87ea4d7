#include "linalg/clustering.h"

#include <algorithm>

#include "linalg/multiset_sampling.h"

namespace lumirank::linalg {

namespace {
// Two thirds of few clusters, as in the paper, and two fifths of many: sampling costs points × centers,
// splitting hardly anything, and from a thousand clusters on the costs of the clusterings are equal.
std::size_t sampled_of(std::size_t clusters) {
  constexpr std::size_t kFew = 400;
  return std::max(std::min(clusters * 2 / 3, kFew), clusters * 2 / 5);
}
}  // namespace

Splitter cluster(const Points& points, std::span<const double> norms, std::span<const std::uint32_t> members,
                 std::span<const std::uint16_t> groups, const ClusteringSettings& settings) {
  Partition start = partition_by_group(members, groups);
  std::size_t sampled = 0;
  if (settings.algorithm == ClusteringAlgorithm::sampling) sampled = settings.clusters;
  if (settings.algorithm == ClusteringAlgorithm::combined) sampled = sampled_of(settings.clusters);
  if (sampled > start.clusters()) {
    const Centers centers = draw_centers(edge_costs(points, norms, start), sampled, settings.seed);
    start = assign_to_centers(points, norms, start, centers);
  }
  Splitter splitter(points, norms, std::move(start), settings.seed);
  if (settings.algorithm != ClusteringAlgorithm::sampling) splitter.split_to(settings.clusters);
  return splitter;
}

}  // namespace lumirank::linalg
