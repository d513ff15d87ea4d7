// Clusters of points of few dimensions, split by their cost (Hašan 2007, section 3.5) on one thread and
// without allocation once its buffers have grown: for many clusterings side by side. Splitter, which finds
// better cuts of many dimensions with all threads, does so at ten times the cost per point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

class LocalSplitter {
 public:
  // Forgets all points. dimension: coordinates of those that follow.
  void clear(std::size_t dimension);
  // Points that follow are in a new cluster. One without points is none.
  void begin_cluster();
  // x: dimension coordinates, not all 0.
  void add(std::uint32_t id, const float* x);

  // Always splits the cluster of highest cost, until there are `clusters` of them or as many as points.
  // Clusters of no cost (their members are parallel) come last, heaviest first. Deterministic.
  // enough: ends earlier, once the root of all clusters' cost is below this share of Σ‖x‖.
  void split_to(std::size_t clusters, double enough = 0);

  std::size_t points() const { return ids_.size(); }
  std::size_t clusters() const { return nodes_.size(); }
  // Any order of clusters and members, but the same for the same points.
  std::span<const std::uint32_t> members(std::size_t k) const {
    return {ids_.data() + nodes_[k].begin, ids_.data() + nodes_[k].end};
  }
  // Of the members, in their order.
  std::span<const float> norms(std::size_t k) const {
    return {norms_.data() + nodes_[k].begin, norms_.data() + nodes_[k].end};
  }
  // Σ over the clusters of (Σ‖x‖)² − ‖Σx‖².
  double cost() const;

  std::size_t memory_bytes() const;

 private:
  static constexpr std::size_t kLanes = 8;  // coordinates are padded to a multiple of it
  static constexpr std::size_t kBins = 32;

  struct Node {
    std::uint32_t begin, end;
    double cost, weight;
  };
  struct Queued {
    double priority;
    std::uint32_t node;
    // Of equals the older comes first.
    bool operator<(const Queued& o) const {
      return priority != o.priority ? priority < o.priority : node > o.node;
    }
  };

  const float* point(std::size_t k) const { return x_.data() + k * padded_; }
  void finish_cluster();
  // sum: of the coordinates and of the norms of its members.
  Node node_of(std::uint32_t begin, std::uint32_t end, const double* sum) const;
  void enqueue(std::uint32_t node);
  // Where it is cut, after the members were brought in order about it; the sums of both sides are in bins_.
  std::uint32_t cut(const Node& node);
  void choose_line(const Node& node);
  void swap_points(std::size_t a, std::size_t b);

  std::size_t dimension_ = 0, padded_ = 0;
  std::vector<float> x_;  // may be longer than its points
  std::vector<float> norms_, keys_, line_;
  std::vector<std::uint32_t> ids_;
  std::vector<Node> nodes_;
  std::vector<Queued> queue_;
  std::vector<double> bins_;  // kBins sums of coordinates and weight, and those of both sides
  std::uint32_t open_ = 0;    // first point of the cluster that is being added
};

}  // namespace lumirank::linalg
