#include "methods/column_completion/column_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/bounds.h"
#include "base/parallel.h"
#include "base/random.h"

namespace lumirank::methods {

using matrix::Index;

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
    for (std::uint32_t k = begin; k < end; ++k) power += static_cast<double>(lights[k].intensity);
    tree.nodes_[node].power = power;
    if (end - begin <= tree.draws_) {
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

ColumnTree::ColumnTree(const matrix::LightingMatrix& matrix, std::size_t draws, std::uint64_t seed)
    : features_(matrix.column_features()), draws_(draws) {
  std::vector<SplitLight> given, others;
  Bounds3f box;
  for (Index j = 0; j < matrix.columns(); ++j) {
    if (!(power_of(j) > 0)) continue;
    const Vec3f place =
        features_.position.empty() ? Vec3f{static_cast<float>(j), 0, 0} : features_.position[j];
    const SplitLight light{is_finite(place) ? place : Vec3f{},
                           features_.normal.empty() ? Vec3f{} : features_.normal[j],
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
  draw(seed);
}

// An exponential variate at the rate of the column's power: of any set of columns each is the first to arrive
// with a probability in proportion to its power.
double ColumnTree::arrival(Index j, std::size_t draw) const {
  const double u = unit_double(hash_ids(seed_, Stage::representatives, matrix::id_of(features_.id, j), draw));
  return -std::log1p(-u) / power_of(j);
}

void ColumnTree::race(Node node) {
  for (std::size_t k = 0; k < draws_; ++k) {
    Index& first = drawn_[node * draws_ + k];
    if (!is_leaf(node)) {
      const Index a = drawn_[left(node) * draws_ + k], b = drawn_[right(node) * draws_ + k];
      first = arrival(a, k) <= arrival(b, k) ? a : b;
      continue;
    }
    first = columns(node).front();
    double earliest = std::numeric_limits<double>::infinity();
    for (const Index j : columns(node))
      if (const double at = arrival(j, k); at < earliest) earliest = at, first = j;
  }
}

void ColumnTree::draw(std::uint64_t seed) {
  seed_ = seed;
  drawn_.resize(nodes_.size() * draws_);
  constexpr std::size_t kGrain = 64;
  parallel_for(nodes_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      if (is_leaf(static_cast<Node>(n))) race(static_cast<Node>(n));
  });
  for (std::size_t n = nodes_.size(); n-- > 0;)
    if (!is_leaf(static_cast<Node>(n))) race(static_cast<Node>(n));
}

std::size_t ColumnTree::memory_bytes() const {
  return nodes_.capacity() * sizeof(Inner) + (order_.capacity() + drawn_.capacity()) * sizeof(Index);
}

}  // namespace lumirank::methods
