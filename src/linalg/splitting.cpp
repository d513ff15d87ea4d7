#include "linalg/splitting.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"

namespace lumirank::linalg {

namespace {

// Members that one task sweeps over.
constexpr std::size_t kSplitStretch = 8192;

PointSum sum_in_order(const Points& points, std::span<const double> norms,
                      std::span<const std::uint32_t> members) {
  PointReader reader(points);
  PointSum sum(points.dimension);
  for (std::uint32_t j : members) sum.add(reader[j], norms[j]);
  return sum;
}

double cost_of(const PointSum& sum) { return std::max(0.0, sum.weight * sum.weight - sum.squared_length()); }

struct Best {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t left = 0;
  Best operator+(const Best& later) const { return later.cost < cost ? later : *this; }
};

// The best cut after one of `members` but the last of all, with `before` the sum of all before them.
Best sweep(const Points& points, std::span<const double> norms, std::span<const std::uint32_t> members,
           const PointSum& before, const PointSum& all, std::size_t cuts) {
  const double all_squared = all.squared_length();
  Best best;
  PointSum left = before;
  double left_squared = before.squared_length(), left_dot_all = 0;
  for (std::size_t d = 0; d < points.dimension; ++d) left_dot_all += before.vector[d] * all.vector[d];
  PointReader reader(points);
  for (std::size_t k = 0; k < std::min(cuts, members.size()); ++k) {
    const std::uint32_t j = members[k];
    const auto x = reader[j];
    left_squared += 2 * dot(x, left.vector.data()) + norms[j] * norms[j];
    left_dot_all += dot(x, all.vector.data());
    left.add(x, norms[j]);
    const double right_weight = all.weight - left.weight;
    const double right_squared = all_squared - 2 * left_dot_all + left_squared;
    const double cost =
        left.weight * left.weight - left_squared + right_weight * right_weight - right_squared;
    if (cost < best.cost) best = {cost, k + 1};
  }
  return best;
}

}  // namespace

Cut best_cut(const Points& points, std::span<const double> norms, std::span<const std::uint32_t> sorted) {
  const std::size_t stretches = (sorted.size() + kSplitStretch - 1) / kSplitStretch;
  const auto stretch = [&](std::size_t s) {
    return sorted.subspan(s * kSplitStretch, std::min(kSplitStretch, sorted.size() - s * kSplitStretch));
  };
  std::vector<PointSum> sums(stretches, PointSum(points.dimension));
  parallel_for(stretches, 1,
               [&](std::size_t s, std::size_t) { sums[s] = sum_in_order(points, norms, stretch(s)); });
  std::vector<PointSum> before(1, PointSum(points.dimension));
  for (const PointSum& s : sums) before.push_back(before.back() + s);

  const Best best = parallel_sum(stretches, 1, Best{}, [&](std::size_t s, std::size_t) {
    const std::size_t first = s * kSplitStretch;
    Best here = sweep(points, norms, stretch(s), before[s], before.back(), sorted.size() - 1 - first);
    here.left += first;
    return here;
  });
  // The running sums choose the place; the two costs are then summed afresh, so that no rounding is carried
  // on.
  Cut cut;
  cut.left = best.left;
  const std::size_t s = best.left / kSplitStretch, within = best.left % kSplitStretch;
  PointSum left = before[s], right(points.dimension);
  if (s < stretches) {
    left = left + sum_in_order(points, norms, stretch(s).first(within));
    right = sum_in_order(points, norms, stretch(s).subspan(within));
  }
  for (std::size_t t = s + 1; t < stretches; ++t) right = right + sums[t];
  cut.left_cost = cost_of(left);
  cut.right_cost = cost_of(right);
  return cut;
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
      if (node.cost <= points_.zero_cost() * weight * weight) node.cost = 0;
    }
  });
  for (std::uint32_t k = 0; k < nodes_.size(); ++k)
    if (nodes_[k].cost > 0) queue_.emplace(-nodes_[k].cost, k);
}

void Splitter::find_cut(Node& node) {
  const std::size_t dim = points_.dimension, size = node.end - node.begin;
  Rng rng(seed_, Stage::clustering, 1 + node.begin, node.end);
  std::vector<double> line(dim);
  for (double& v : line) v = rng.next_gaussian();
  std::vector<std::pair<float, std::uint32_t>> keys(size);
  parallel_for(size, 8192, [&](std::size_t b, std::size_t e) {
    PointReader reader(points_);
    for (std::size_t k = b; k < e; ++k) {
      const std::uint32_t j = order_[node.begin + k];
      keys[k] = {norms_[j] > 0 ? static_cast<float>(dot(reader[j], line.data()) / norms_[j]) : 0.0f, j};
    }
  });
  parallel_sort(keys.begin(), keys.end(), std::less<>());
  for (std::size_t k = 0; k < size; ++k) order_[node.begin + k] = keys[k].second;
  const std::span<const std::uint32_t> sorted{order_.data() + node.begin, size};
  node.cut = best_cut(points_, norms_, sorted);
  double left = 0, right = 0;
  for (std::size_t k = 0; k < size; ++k) (k < node.cut.left ? left : right) += norms_[sorted[k]];
  if (node.cut.left_cost <= points_.zero_cost() * left * left) node.cut.left_cost = 0;
  if (node.cut.right_cost <= points_.zero_cost() * right * right) node.cut.right_cost = 0;
  node.cut_known = true;
}

// Cuts of the clusters that come next are found side by side. Which of them are found ahead changes nothing
// but time.
void Splitter::prepare_costliest(std::size_t wanted) {
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
    if (!nodes_[k].cut_known) prepare_costliest(clusters - nodes_.size());
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
