#include "linalg/splitting.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"

namespace lumirank::linalg {

Cut best_cut(const Points& points, std::span<const double> norms, std::span<const std::uint32_t> sorted) {
  const std::size_t dim = points.dimension;
  PointSum all(dim);
  for (std::uint32_t j : sorted) all.add(points[j], norms[j]);
  const double all_squared = all.squared_length();

  Cut best;
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> left(dim, 0.0);
  double left_weight = 0, left_squared = 0, left_dot_all = 0;
  for (std::size_t k = 0; k + 1 < sorted.size(); ++k) {
    const std::uint32_t j = sorted[k];
    const float* x = points.data + j * dim;
    double x_left = 0, x_all = 0;
    for (std::size_t d = 0; d < dim; ++d) {
      const double v = static_cast<double>(x[d]);
      x_left += v * left[d];
      x_all += v * all.vector[d];
      left[d] += v;
    }
    left_weight += norms[j];
    left_squared += 2 * x_left + norms[j] * norms[j];
    left_dot_all += x_all;
    const double right_weight = all.weight - left_weight;
    const double right_squared = all_squared - 2 * left_dot_all + left_squared;
    const double left_cost = left_weight * left_weight - left_squared;
    const double right_cost = right_weight * right_weight - right_squared;
    if (left_cost + right_cost < least) {
      least = left_cost + right_cost;
      best.left = k + 1;
    }
  }
  // The running sums choose the place; the two costs are then summed afresh, so that no rounding is carried
  // on.
  best.left_cost = cluster_cost(points, norms, sorted.first(best.left));
  best.right_cost = cluster_cost(points, norms, sorted.subspan(best.left));
  return best;
}

Splitter::Splitter(const Points& points, std::span<const double> norms, Partition start, std::uint64_t seed)
    : points_(points), norms_(norms), seed_(seed), order_(std::move(start.order)) {
  nodes_.resize(start.clusters());
  parallel_for(nodes_.size(), 8, [&](std::size_t b, std::size_t e) {
    for (std::size_t k = b; k < e; ++k) {
      Node& node = nodes_[k];
      node.begin = start.starts[k];
      node.end = start.starts[k + 1];
      const std::span<const std::uint32_t> members{order_.data() + node.begin, order_.data() + node.end};
      node.cost = cluster_cost(points_, norms_, members);
      double weight = 0;
      for (std::uint32_t j : members) weight += norms_[j];
      if (node.cost <= kZeroCost * weight * weight) node.cost = 0;
    }
  });
  for (std::uint32_t k = 0; k < nodes_.size(); ++k)
    if (nodes_[k].cost > 0) queue_.emplace(-nodes_[k].cost, k);
}

void Splitter::find_cut(Node& node) {
  const std::size_t dim = points_.dimension, size = node.end - node.begin;
  Rng rng(seed_, Stage::clustering, 1 + node.begin, node.end);
  std::vector<float> line(dim);
  for (float& v : line) v = static_cast<float>(rng.next_gaussian());
  std::vector<std::pair<float, std::uint32_t>> keys(size);
  parallel_for(size, 8192, [&](std::size_t b, std::size_t e) {
    for (std::size_t k = b; k < e; ++k) {
      const std::uint32_t j = order_[node.begin + k];
      float dot = 0;
      for (std::size_t d = 0; d < dim; ++d) dot += line[d] * points_.data[j * dim + d];
      keys[k] = {norms_[j] > 0 ? dot / static_cast<float>(norms_[j]) : 0.0f, j};
    }
  });
  std::sort(keys.begin(), keys.end());
  for (std::size_t k = 0; k < size; ++k) order_[node.begin + k] = keys[k].second;
  const std::span<const std::uint32_t> sorted{order_.data() + node.begin, size};
  node.cut = best_cut(points_, norms_, sorted);
  double left = 0, right = 0;
  for (std::size_t k = 0; k < size; ++k) (k < node.cut.left ? left : right) += norms_[sorted[k]];
  if (node.cut.left_cost <= kZeroCost * left * left) node.cut.left_cost = 0;
  if (node.cut.right_cost <= kZeroCost * right * right) node.cut.right_cost = 0;
  node.cut_known = true;
}

// Cuts of the clusters that come next are found side by side. Which of them are found ahead changes nothing
// but time.
void Splitter::prepare_most_costly(std::size_t wanted) {
  std::vector<std::uint32_t> next;
  for (auto it = queue_.begin(); it != queue_.end() && next.size() < std::min<std::size_t>(wanted, 32); ++it)
    if (!nodes_[it->second].cut_known) next.push_back(it->second);
  parallel_for(next.size(), 1, [&](std::size_t b, std::size_t e) {
    for (std::size_t k = b; k < e; ++k) find_cut(nodes_[next[k]]);
  });
}

bool Splitter::split_to(std::size_t clusters) {
  while (nodes_.size() < clusters && !queue_.empty()) {
    const std::uint32_t k = queue_.begin()->second;
    if (!nodes_[k].cut_known) prepare_most_costly(clusters - nodes_.size());
    queue_.erase(queue_.begin());
    const Node whole = nodes_[k];
    const auto middle = static_cast<std::uint32_t>(whole.begin + whole.cut.left);
    const auto fresh = static_cast<std::uint32_t>(nodes_.size());
    nodes_[k] = {whole.begin, middle, whole.cut.left_cost, false, {}};
    nodes_.push_back({middle, whole.end, whole.cut.right_cost, false, {}});
    for (std::uint32_t n : {k, fresh})
      if (nodes_[n].cost > 0) queue_.emplace(-nodes_[n].cost, n);
  }
  return nodes_.size() >= clusters;
}

double Splitter::cost() const {
  double s = 0;
  for (const Node& n : nodes_) s += n.cost;
  return s;
}

Partition Splitter::partition() const {
  Partition p;
  p.order = order_;
  for (const Node& n : nodes_) p.starts.push_back(n.begin);
  p.starts.push_back(static_cast<std::uint32_t>(order_.size()));
  std::sort(p.starts.begin(), p.starts.end());
  return p;
}

}  // namespace lumirank::linalg
