#include "methods/column_completion/column_tree.h"

#include <algorithm>
#include <bit>
#include <queue>

#include "base/bounds.h"

namespace lumirank::methods {

using matrix::Index;

namespace {

constexpr double kStrong = 1.0 / 256;

}  // namespace

struct ColumnTree::Builder {
  ColumnTree& tree;
  std::vector<SplitLight>& lights;  // in the order of the leaves
  std::span<const std::uint64_t> branches;
  float across;

  // Splits seldom fail to divide columns fairly; where they do, halves keep recursion short.
  static constexpr int kDeepestSplit = 128;

  std::uint64_t branch(std::size_t place) const {
    return branches.empty() ? 0 : branches[lights[place].column];
  }

  // Of lights[begin, end), which ascend by branch from bit `level` on.
  void build(std::uint32_t begin, std::uint32_t end, int depth) {
    const Node node = static_cast<Node>(tree.nodes_.size());
    tree.nodes_.push_back({begin, end});
    double power = 0;
    for (std::uint32_t k = begin; k < end; ++k) {
      power += static_cast<double>(lights[k].intensity);
      tree.nodes_[node].box.extend(lights[k].position);
    }
    tree.nodes_[node].power = power;
    if (end - begin <= tree.leaf_) {
      for (std::uint32_t k = begin; k < end; ++k) tree.order_[k] = lights[k].column;
      return;
    }
    const std::uint32_t middle = divide(begin, end, depth);
    build(begin, middle, depth + 1);
    tree.nodes_[node].right = static_cast<Node>(tree.nodes_.size());
    build(middle, end, depth + 1);
  }

  std::uint32_t divide(std::uint32_t begin, std::uint32_t end, int depth) {
    const std::uint64_t first = branch(begin), last = branch(end - 1);
    if (first != last) {
      // The highest bit in which they differ divides them.
      const std::uint64_t bit = std::uint64_t{1} << (63 - std::countl_zero(first ^ last));
      std::uint32_t low = begin + 1, high = end - 1;
      while (low < high) {
        const std::uint32_t at = low + (high - low) / 2;
        if (branch(at) & bit)
          high = at;
        else
          low = at + 1;
      }
      return low;
    }
    const auto stretch = std::span(lights).subspan(begin, end - begin);
    return begin + static_cast<std::uint32_t>(depth < kDeepestSplit ? split_lights(stretch, across)
                                                                    : stretch.size() / 2);
  }
};

ColumnTree::ColumnTree(const matrix::LightingMatrix& matrix, std::size_t leaf, std::size_t cut)
    : features_(matrix.column_features()), leaf_(leaf) {
  std::vector<SplitLight> given, others;
  Bounds3f box;
  const auto is_emitter = [&](Index j) { return j < features_.indirect.size() && !features_.indirect[j]; };
  double of_emitters = 0;
  for (Index j = 0; j < matrix.columns(); ++j)
    if (is_emitter(j)) of_emitters += power_of(j);
  for (Index j = 0; j < matrix.columns(); ++j) {
    if (!(power_of(j) > 0)) continue;
    if (is_emitter(j) && power_of(j) > kStrong * of_emitters) {
      strong_emitters_.push_back(j);
      continue;
    }
    const SplitLight light{place_of(j), features_.normal.empty() ? Vec3f{} : features_.normal[j],
                           static_cast<float>(std::min(power_of(j), 1e30)), j};
    box.extend(light.position);
    const bool in_tree = !features_.branch.empty() && features_.branch[j] != matrix::kNoBranch;
    (in_tree ? given : others).push_back(light);
  }
  std::stable_sort(given.begin(), given.end(), [&](const SplitLight& a, const SplitLight& b) {
    return features_.branch[a.column] < features_.branch[b.column];
  });
  std::vector<SplitLight> all = std::move(others);
  const auto first_given = static_cast<std::uint32_t>(all.size());
  all.insert(all.end(), given.begin(), given.end());
  const auto count = static_cast<std::uint32_t>(all.size());
  order_.resize(count);
  const float across = count > 0 ? length(box.diagonal()) : 0.0f;
  if (first_given > 0) {
    roots_.push_back({static_cast<Node>(nodes_.size()), false});
    Builder{*this, all, {}, across}.build(0, first_given, 0);
  }
  if (first_given < count) {
    roots_.push_back({static_cast<Node>(nodes_.size()), true});
    Builder{*this, all, features_.branch, across}.build(first_given, count, 0);
  }
  make_coarse(cut);
}

// The node with the most power is divided next.
void ColumnTree::make_coarse(std::size_t cut) {
  coarse_of_.assign(nodes_.size(), kFine);
  std::priority_queue<std::pair<double, Node>> open;
  std::vector<Node> divided;
  for (const Root& r : roots_) open.emplace(nodes_[r.node].power, r.node);
  while (!open.empty()) {
    const Node node = open.top().second;
    open.pop();
    if (is_leaf(node) || cut_.size() + open.size() + 1 >= cut) {
      cut_.push_back(node);
      continue;
    }
    divided.push_back(node);
    for (const Node child : {left(node), right(node)}) open.emplace(nodes_[child].power, child);
  }
  std::sort(cut_.begin(), cut_.end());
  for (const Node node : cut_) coarse_.push_back({node, false});
  for (const Node node : divided) coarse_.push_back({node, true});
  // Numbers ascend down the tree.
  std::sort(coarse_.begin(), coarse_.end(), [](const Coarse& a, const Coarse& b) { return a.node < b.node; });
  for (std::uint32_t k = 0; k < coarse_.size(); ++k) coarse_of_[coarse_[k].node] = k;
}

Vec3f ColumnTree::place_of(Index j) const {
  if (features_.position.empty()) return {static_cast<float>(j), 0, 0};
  const Vec3f place = features_.position[j];
  return is_finite(place) ? place : Vec3f{};
}

namespace {

// What light falls off by from what fills a ball to rows that fill another: no more than if both were next to
// each other.
double nearness(Vec3f center, float radius, const ColumnTree::Place& from) {
  const double reach = static_cast<double>(radius + from.radius);
  return 1 / (static_cast<double>(length_squared(center - from.center)) + reach * reach + 1e-30);
}

}  // namespace

double ColumnTree::left_by_nearness(Node node, const Place& from) const {
  const auto weight = [&](Node child) {
    const Inner& n = nodes_[child];
    return n.power * nearness(n.box.center(), n.box.radius(), from);
  };
  const double left_weight = weight(left(node)), right_weight = weight(right(node));
  return left_weight / (left_weight + right_weight);
}

ColumnTree::Drawn ColumnTree::draw_by_nearness(Node node, const Place& from, Rng& rng) const {
  return walk(node, from, rng, [&](Node n) { return left_by_nearness(n, from); });
}

ColumnTree::Drawn ColumnTree::draw_in_leaf(Node leaf, const Place& from, Rng& rng) const {
  const auto weight = [&](Index j) { return power_of(j) * nearness(place_of(j), 0, from); };
  double all = 0;
  for (const Index j : columns(leaf)) all += weight(j);
  const double at = rng.next_double() * all;
  double sum = 0;
  std::uint32_t place = nodes_[leaf].begin;
  for (; place + 1 < nodes_[leaf].end; ++place) {
    const double own = weight(order_[place]);
    if (at < sum + own) break;
    sum += own;
  }
  return {place, weight(order_[place]) / all};
}

std::size_t ColumnTree::memory_bytes() const {
  return nodes_.capacity() * sizeof(Inner) + order_.capacity() * sizeof(Index) +
         coarse_of_.capacity() * sizeof(std::uint32_t);
}

}  // namespace lumirank::methods
