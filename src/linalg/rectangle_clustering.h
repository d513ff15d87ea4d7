// Clusters of light-frame pairs that are rectangles, a set of lights in a range of frames (Hašan et al. 2008,
// section 4.3.2): again and again the costliest is split, in lights or in time, whichever leaves less cost.
//
// The cost of a cluster is Σ w_p w_q ‖x_p − x_q‖² over its ordered pairs, which is 2·(Σw · Σ w‖x‖² − ‖Σ w
// x‖²): running sums give the cost of both parts at every place of a split.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "linalg/partition.h"
#include "linalg/reduced_tensor.h"

namespace lumirank::linalg {

class RectangleClustering {
 public:
  struct Rectangle {
    std::vector<std::uint32_t> lights;
    std::uint32_t begin = 0, end = 0;  // frames [begin, end)
    double cost = 0;
  };

  // `start`: clusters of lights, each in all frames (the paper starts from 100). `time_weight`: how much less
  // cost a split in time must leave to be taken (1: the paper's choice; 0: never; above 1 time is preferred).
  // The tensor must outlive this.
  RectangleClustering(const ReducedTensor& tensor, const Partition& start, std::uint64_t seed,
                      double time_weight = 1);

  // Splits until there are so many; false if there are fewer because no cluster has any cost. The order of
  // splits, so every number of clusters, is a function of the seed alone.
  bool split_to(std::size_t clusters);

  const std::vector<Rectangle>& rectangles() const { return rectangles_; }
  double cost() const;

 private:
  // How a rectangle is best split.
  struct Split {
    bool known = false, in_time = false;
    std::uint32_t frame = 0;            // in time: the first of the second part
    std::vector<std::uint32_t> sorted;  // in lights: the order, and how many make the first part
    std::size_t left = 0;
    double left_cost = 0, right_cost = 0;
  };
  struct Sums;

  Sums sums_of(const Rectangle& rectangle) const;
  Split best_split(std::size_t k) const;
  void split_in_time(const Rectangle& rectangle, const Sums& sums, Split& best) const;
  void split_in_lights(const Rectangle& rectangle, const Sums& sums, std::uint64_t key, Split& best) const;
  std::vector<float> projections(const Rectangle& rectangle, std::size_t a, std::size_t b) const;
  void prepare_costliest(std::size_t wanted);

  const ReducedTensor& tensor_;
  std::uint64_t seed_;
  double time_weight_;
  std::vector<Rectangle> rectangles_;
  std::vector<Split> splits_;
  std::set<std::pair<double, std::uint32_t>> queue_;  // by falling cost
};

}  // namespace lumirank::linalg
