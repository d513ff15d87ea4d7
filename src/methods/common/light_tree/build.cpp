#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "methods/common/light_tree/light_tree.h"
#include "methods/common/light_tree/split.h"

namespace lumirank::methods {

using matrix::ColumnSet;
using matrix::Cone;
using matrix::Emission;
using matrix::Index;

struct LightTree::Builder {
  LightTree& tree;
  std::uint64_t seed;
  std::vector<SplitLight>& lights;  // in the order of the leaves
  float across;                     // c of the measure
  bool narrow;                      // every column has but one direction

  // Splits seldom fail to divide lights fairly; where they do, halves keep recursion short.
  static constexpr int kDeepest = 64;
  static constexpr std::uint32_t kTask = 1 << 12;

  ColumnSet build(Node node, Node parent, std::uint32_t begin, std::uint32_t end, int depth) {
    if (end - begin == 1) {
      tree.order_[begin] = lights[begin].column;
      tree.leaf_parent_[begin] = parent;
      return tree.matrix_.column_set(lights[begin].column);
    }
    const auto stretch = std::span(lights).subspan(begin, end - begin);
    const auto left_size =
        static_cast<std::uint32_t>(depth < kDeepest ? split_lights(stretch, across) : stretch.size() / 2);
    const std::uint32_t middle = begin + left_size;
    ColumnSet halves[2];
    const auto build_half = [&](std::size_t side) {
      halves[side] = side == 0 ? build(node + 1, node, begin, middle, depth + 1)
                               : build(node + left_size, node, middle, end, depth + 1);
    };
    if (end - begin > kTask) {
      parallel_for(2, 1, [&](std::size_t b, std::size_t e) {
        for (std::size_t side = b; side < e; ++side) build_half(side);
      });
    } else {
      build_half(0), build_half(1);
    }
    ColumnSet set = join(halves[0], halves[1]);
    if (set.emission != Emission::omni) tighten(set.cone, begin, end);
    store(node, parent, begin, end, left_size, set);
    return set;
  }

  // The cone about the mean of all directions, if it is the narrower one: joined pairwise, cones grow.
  void tighten(Cone& cone, std::uint32_t begin, std::uint32_t end) const {
    if (!narrow || cone.cosine >= 1) return;
    Vec3f sum;
    for (std::uint32_t k = begin; k < end; ++k) sum += lights[k].direction;
    const float size = length(sum);
    if (!(size > 1e-3f)) return;
    const Vec3f axis = sum / size;
    float cosine = 1;
    for (std::uint32_t k = begin; k < end; ++k) cosine = std::min(cosine, dot(axis, lights[k].direction));
    cosine -= 4e-7f;  // roundings
    if (cosine > cone.cosine) cone = {axis, cosine};
  }

  void store(Node node, Node parent, std::uint32_t begin, std::uint32_t end, std::uint32_t left_size,
             const ColumnSet& set) {
    Inner& inner = tree.nodes_[node];
    inner.box = set.box, inner.cone = set.cone;
    inner.intensity = set.intensity, inner.ceiling = set.ceiling;
    inner.begin = begin, inner.end = end, inner.left_size = left_size, inner.parent = parent;
    inner.emission = static_cast<std::uint32_t>(set.emission) & 3u;
    inner.spherical = set.spherical, inner.direct = set.direct;
    if (!tree.extents_.empty())
      tree.extents_[node] = {set.radius, set.min_radius, set.min_length, set.medium};
    const Node left = tree.left(node), right = tree.right(node);
    inner.emitted = tree.emitted(left) + tree.emitted(right);
    const Index first = tree.representative(left), second = tree.representative(right);
    inner.representative = arrival(first) <= arrival(second) ? first : second;
  }

  // An exponential variate at the rate of the column's power: of any set of columns each is the first to
  // arrive with a probability in proportion to its power, and the first of all is the first of its own part.
  // Who it is hangs on the columns' ids alone, not on their order or on how the tree divides them.
  double arrival(Index j) const {
    const double power = static_cast<double>(tree.power_of(j));
    const double u =
        unit_double(hash_ids(seed, Stage::representatives, matrix::id_of(tree.features_.id, j), 1));
    return power > 0 ? -std::log1p(-u) / power : std::numeric_limits<double>::infinity();
  }
};

namespace {

// What columns must have in common to stand in one tree; kDark: they send nothing.
using Kind = std::uint64_t;
constexpr Kind kDark = ~Kind{0};
Kind kind_of(const ColumnSet& set, std::uint16_t group) {
  if (is_black(set.intensity)) return kDark;
  return Kind{static_cast<std::uint16_t>(set.medium)} << 20 | Kind{group} << 4 |
         static_cast<Kind>(set.emission) << 2 | Kind{set.spherical} << 1 | Kind{set.direct};
}

bool is_extended(Kind kind) { return (kind & 2) != 0 || (kind >> 2 & 3) == static_cast<Kind>(Emission::ray); }

SplitLight split_light(const ColumnSet& set, Index column) {
  const bool directional = set.emission == Emission::directional;
  return {directional ? Vec3f{} : set.box.center(), set.emission == Emission::omni ? Vec3f{} : set.cone.axis,
          std::min(mean(set.intensity), 1e30f), column};
}

struct Whole {
  Bounds3f box;
  bool narrow = true;
  friend Whole operator+(Whole a, const Whole& b) {
    a.box.extend(b.box);
    a.narrow = a.narrow && b.narrow;
    return a;
  }
};

}  // namespace

LightTree::LightTree(const matrix::LightingMatrix& matrix, std::uint64_t seed)
    : seed_(seed), matrix_(matrix), features_(matrix.column_features()) {
  constexpr std::size_t kGrain = 1 << 14;
  const std::size_t n = matrix.columns();
  if (n >= std::size_t{1} << 27) throw InternalError("light tree: too many columns");
  std::vector<Kind> kinds(n);
  parallel_for(n, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      kinds[j] = kind_of(matrix.column_set(static_cast<Index>(j)),
                         features_.group.empty() ? std::uint16_t{0} : features_.group[j]);
  });
  std::map<Kind, std::uint32_t> sizes;
  for (const Kind kind : kinds)
    if (kind != kDark) ++sizes[kind];
  std::map<Kind, std::uint32_t> next;
  std::vector<std::uint32_t> firsts{0};
  for (const auto& [kind, size] : sizes) next[kind] = firsts.back(), firsts.push_back(firsts.back() + size);
  order_.resize(firsts.back());
  bool extended = false;  // some are spheres or rays
  for (std::size_t j = 0; j < n; ++j) {
    if (kinds[j] == kDark) continue;
    order_[next[kinds[j]]++] = static_cast<Index>(j);
    extended = extended || is_extended(kinds[j]);
  }
  kinds = {};

  std::vector<SplitLight> lights(order_.size());
  const Whole whole = parallel_sum(lights.size(), kGrain, Whole{}, [&](std::size_t begin, std::size_t end) {
    Whole part;
    for (std::size_t k = begin; k < end; ++k) {
      const ColumnSet set = matrix.column_set(order_[k]);
      lights[k] = split_light(set, order_[k]);
      if (set.emission != Emission::directional) part.box.extend(set.box);
      if (set.emission != Emission::omni) part.narrow = part.narrow && set.cone.cosine >= 1;
    }
    return part;
  });
  const std::size_t trees = firsts.size() - 1;
  nodes_.resize(lights.size() - trees);
  if (extended) extents_.resize(nodes_.size());
  leaf_parent_.resize(lights.size());
  roots_.resize(trees);
  parallel_for(trees, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t t = from; t < to; ++t) {
      const bool directional = matrix.column_set(lights[firsts[t]].column).emission == Emission::directional;
      Builder builder{*this, seed, lights, directional ? 1.0f : whole.box.radius(), whole.narrow};
      // Each tree has one inner node less than leaves.
      roots_[t] = firsts[t + 1] - firsts[t] == 1 ? kLeaf | firsts[t] : static_cast<Node>(firsts[t] - t);
      builder.build(static_cast<Node>(firsts[t] - t), kNone, firsts[t], firsts[t + 1], 0);
    }
  });
}

}  // namespace lumirank::methods
