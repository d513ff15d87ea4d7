// Clustering by top-down splitting (Hašan 2007, section 3.5): always the cluster of highest cost, at the best
// place along a random line. Can be stopped at any number of clusters and continued.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "linalg/partition.h"

namespace lumirank::linalg {

// The best cut of a sorted sequence into two: `left` members, with the least sum of the two costs, found in
// one sweep over running sums, O(n · dimension). Stretches of the sequence are swept side by side.
struct Cut {
  std::size_t left = 0;
  double left_cost = 0, right_cost = 0;
};
Cut best_cut(const Points& points, std::span<const double> norms, std::span<const std::uint32_t> sorted);

class Splitter {
 public:
  // Holds references to points and norms. A cluster's split is a function of (seed, its members) alone, so
  // splitting on in two steps gives the same clusters as in one.
  Splitter(const Points& points, std::span<const double> norms, Partition start, std::uint64_t seed);

  // Splits until there are `clusters` of them, or all have zero cost. False in the second case.
  bool split_to(std::size_t clusters);
  std::size_t clusters() const { return nodes_.size(); }
  double cost() const;
  // Clusters in the order of their ranges.
  Partition partition() const;

 private:
  struct Node {
    std::uint32_t begin, end;
    double cost;
    bool cut_known = false;
    Cut cut;
  };
  void find_cut(Node& node);
  void prepare_costliest(std::size_t wanted);

  Points points_;
  std::span<const double> norms_;
  std::uint64_t seed_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  std::set<std::pair<double, std::uint32_t>> queue_;  // (−cost, node): the most costly first, ties by age
};

}  // namespace lumirank::linalg
