#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "base/parallel.h"
#include "base/random.h"
#include "base/warp.h"
#include "matrix/synthetic.h"
#include "methods/common/light_tree/light_tree.h"
#include "methods/unbiasedness.h"

namespace lumirank::methods {
namespace {

using matrix::ColumnSet;
using matrix::Cost;
using matrix::Emission;
using matrix::Index;
using Node = LightTree::Node;

// Columns of all kinds at random places, without entries.
class MixedLights final : public matrix::LightingMatrix {
 public:
  MixedLights(std::size_t count, std::uint64_t seed) : group(count) {
    Rng rng(seed, Stage::test);
    for (std::size_t j = 0; j < count; ++j) {
      ColumnSet set;
      set.emission = static_cast<Emission>(rng.next_below(3));
      set.spherical = set.emission != Emission::directional && rng.next_float() < 0.3f;
      set.direct = rng.next_float() < 0.5f;
      // A quarter share few places and directions, so that many are alike.
      const bool alike = rng.next_float() < 0.25f;
      const Vec3f p =
          alike ? Vec3f{static_cast<float>(rng.next_below(3)), 0, 1} : warp_sphere(rng.next_2d()) * 3.0f;
      set.box.extend(p);
      if (rng.next_float() < 0.1f) set.box.extend(p + Vec3f{0.1f, 0.2f, 0.3f});
      if (set.emission != Emission::omni)
        set.cone = {alike ? Vec3f{0, 0, 1} : normalize(warp_sphere(rng.next_2d()) + Vec3f{0, 0, 0.5f}),
                    rng.next_float() < 0.1f ? 0.9f : 1.0f};
      if (set.spherical) set.radius = set.min_radius = rng.next_float() + 0.01f;
      set.intensity =
          rng.next_float() < 0.05f ? Rgb(0) : Rgb(rng.next_float(), rng.next_float(), rng.next_float());
      if (rng.next_float() < 0.5f) set.ceiling = set.intensity * 2;
      sets.push_back(set);
      group[j] = static_cast<std::uint16_t>(rng.next_below(2));
      emitted.push_back(set.intensity * rng.next_float());
    }
  }
  std::size_t rows() const override { return 0; }
  std::size_t columns() const override { return sets.size(); }
  Cost row(Index, std::span<Rgb>, matrix::Part) const override { return {}; }
  Cost column(Index, std::span<Rgb>, matrix::Part) const override { return {}; }
  Cost block(std::span<const Index>, std::span<const Index>, std::span<Rgb>, matrix::Part) const override {
    return {};
  }
  Cost entries(std::span<const Index>, std::span<const Index>, std::span<Rgb>, matrix::Part) const override {
    return {};
  }
  Cost accumulate(std::span<const matrix::ScaledColumn>, std::span<Rgb>, const Sinks&) const override {
    return {};
  }
  ColumnSet column_set(Index j) const override { return sets[j]; }
  matrix::ColumnFeatures column_features() const override {
    matrix::ColumnFeatures features;
    features.group = group, features.emitted = emitted, features.id = id;
    return features;
  }

  std::vector<ColumnSet> sets;
  std::vector<std::uint16_t> group;
  std::vector<Rgb> emitted;
  std::vector<std::uint64_t> id;  // unknown unless set
};

void visit(const LightTree& tree, Node node, std::vector<Node>& all) {
  all.push_back(node);
  if (tree.is_leaf(node)) return;
  visit(tree, tree.left(node), all), visit(tree, tree.right(node), all);
}
std::vector<Node> all_nodes(const LightTree& tree) {
  std::vector<Node> all;
  for (const Node root : tree.roots()) visit(tree, root, all);
  return all;
}

// Precise for nearly equal vectors, which need not be quite unit.
double angle(Vec3f a, Vec3f b) {
  const double x = a.x, y = a.y, z = a.z, u = b.x, v = b.y, w = b.z;
  return std::atan2(std::hypot(y * w - z * v, z * u - x * w, x * v - y * u), x * u + y * v + z * w);
}

bool holds(const matrix::Cone& cone, const matrix::Cone& part) {
  if (cone.cosine <= -1) return true;
  const double between = angle(cone.axis, part.axis);
  return std::cos(between + std::acos(static_cast<double>(part.cosine))) >= cone.cosine - 3e-7;
}

TEST(LightTree, HasEveryColumnThatEmitsOnce) {
  for (const std::size_t count : {1, 2, 3, 50, 3000}) {
    const MixedLights lights(count, count);
    const LightTree tree(lights, 1);
    std::vector<int> seen(count, 0);
    for (const Node root : tree.roots())
      for (const Index j : tree.columns(root)) ++seen[j];
    for (std::size_t j = 0; j < count; ++j) EXPECT_EQ(seen[j], is_black(lights.sets[j].intensity) ? 0 : 1);
    EXPECT_EQ(tree.leaves(), tree.order().size());
  }
}

TEST(LightTree, NodesBoundTheirColumnsAndAddThemUp) {
  const MixedLights lights(3000, 5);
  const LightTree tree(lights, 1);
  for (const Node node : all_nodes(tree)) {
    const ColumnSet set = tree.set(node);
    double intensity[3] = {0, 0, 0}, ceiling[3] = {0, 0, 0}, emitted[3] = {0, 0, 0}, power = 0;
    bool found = false;
    for (const Index j : tree.columns(node)) {
      const ColumnSet& one = lights.sets[j];
      ASSERT_EQ(one.emission, set.emission);
      ASSERT_EQ(one.spherical, set.spherical);
      ASSERT_EQ(one.direct, set.direct);
      ASSERT_EQ(lights.group[j], lights.group[tree.columns(node)[0]]);
      for (int a = 0; a < 3; ++a) {
        ASSERT_LE(set.box.lo[a], one.box.lo[a]);
        ASSERT_GE(set.box.hi[a], one.box.hi[a]);
        intensity[a] += one.intensity[a], ceiling[a] += one.ceiling[a], emitted[a] += lights.emitted[j][a];
      }
      if (set.emission != Emission::omni) {
        ASSERT_TRUE(holds(set.cone, one.cone));
      }
      if (set.spherical) {
        ASSERT_LE(set.min_radius, one.radius);
        ASSERT_GE(set.radius, one.radius);
      }
      power += luminance(lights.emitted[j]);
      found = found || j == tree.representative(node);
    }
    EXPECT_TRUE(found);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(set.intensity[c], intensity[c], 1e-5 * intensity[c]);
      EXPECT_NEAR(tree.emitted(node)[c], emitted[c], 1e-5 * emitted[c]);
      if (std::isfinite(ceiling[c])) {
        EXPECT_NEAR(set.ceiling[c], ceiling[c], 1e-5 * ceiling[c]);
      } else {
        EXPECT_EQ(set.ceiling[c], kInfinity);
      }
    }
    EXPECT_NEAR(tree.power(node), power, 1e-5 * power);
  }
}

TEST(LightTree, ChildrenDivideTheirParent) {
  const MixedLights lights(3000, 6);
  const LightTree tree(lights, 1);
  for (const Node root : tree.roots()) EXPECT_EQ(tree.parent(root), LightTree::kNone);
  for (const Node node : all_nodes(tree)) {
    if (tree.is_leaf(node)) continue;
    const Node left = tree.left(node), right = tree.right(node);
    EXPECT_EQ(tree.parent(left), node);
    EXPECT_EQ(tree.parent(right), node);
    EXPECT_EQ(tree.columns(left).data(), tree.columns(node).data());
    EXPECT_EQ(tree.columns(left).data() + tree.columns(left).size(), tree.columns(right).data());
    EXPECT_EQ(tree.columns(left).size() + tree.columns(right).size(), tree.columns(node).size());
    const Index representative = tree.representative(node);
    EXPECT_TRUE(representative == tree.representative(left) || representative == tree.representative(right));
  }
}

TEST(LightTree, IsTheSameOnAnyNumberOfThreads) {
  const MixedLights lights(100000, 7);
  std::vector<std::vector<Index>> orders, representatives;
  for (const int threads : {1, 2, 4})
    with_threads(threads, [&] {
      const LightTree tree(lights, 3);
      orders.emplace_back(tree.order().begin(), tree.order().end());
      representatives.emplace_back();
      for (const Node node : all_nodes(tree)) {
        representatives.back().push_back(node);
        representatives.back().push_back(tree.representative(node));
      }
    });
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_EQ(orders[k], orders[0]);
    EXPECT_EQ(representatives[k], representatives[0]);
  }
}

// Drawn in proportion to power: over 4000 seeds (800 under sanitizers) the root of each tree of a small
// forest. Each tree's counts are passed with probability 0.999. Second representatives, by as many keys,
// likewise.
TEST(LightTree, RepresentativesAreDrawnByPower) {
  const MixedLights lights(120, 8);
  const auto seeds = static_cast<int>(test::runs(4000));
  std::vector<int> first(lights.columns(), 0), second(lights.columns(), 0);
  const LightTree tree(lights, 0);
  for (int seed = 0; seed < seeds; ++seed) {
    const LightTree other(lights, static_cast<std::uint64_t>(seed));
    for (const Node root : other.roots()) ++first[other.representative(root)];
    for (const Node root : tree.roots())
      ++second[tree.redrawn(root, static_cast<std::uint64_t>(seed)).column];
  }
  for (const std::vector<int>& drawn : {first, second})
    for (const Node root : tree.roots()) {
      lumirank::test::ChiSquareTest chi2;
      for (const Index j : tree.columns(root))
        chi2.add(drawn[j], seeds * static_cast<double>(luminance(lights.emitted[j])) / tree.power(root));
      if (chi2.bins() > 1) {
        EXPECT_GT(chi2.tail(), 1e-3) << chi2.bins();
      }
    }
}

// Lights left out and the others in disorder: who stood for a tree and is still there stands for it again.
TEST(LightTree, RepresentativesSurviveAnotherOrderAndFewerLights) {
  std::size_t kept = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    MixedLights all(200, seed);
    for (std::size_t j = 0; j < all.columns(); ++j) all.id.push_back(hash_ids(seed, Stage::test, j));
    MixedLights some = all;
    some.sets.clear(), some.group.clear(), some.emitted.clear(), some.id.clear();
    std::map<std::uint64_t, Index> there;
    for (std::size_t k = 0; k < all.columns(); ++k) {
      const std::size_t j = (k * 77 + 13) % all.columns();  // 77 and 200 have no common divisor
      if (j % 3 == 0) continue;
      there[all.id[j]] = static_cast<Index>(some.sets.size());
      some.sets.push_back(all.sets[j]), some.group.push_back(all.group[j]);
      some.emitted.push_back(all.emitted[j]), some.id.push_back(all.id[j]);
    }
    const LightTree whole(all, seed), part(some, seed);
    std::map<Index, Index> chosen;  // of each column of the part, by its root
    for (const Node root : part.roots())
      for (const Index j : part.columns(root)) chosen[j] = part.representative(root);
    for (const Node root : whole.roots()) {
      const auto found = there.find(all.id[whole.representative(root)]);
      if (found == there.end()) continue;
      EXPECT_EQ(chosen.at(found->second), found->second);
      ++kept;
    }
  }
  EXPECT_GT(kept, 50u);
}

// So that a finer cut keeps what a coarser one had.
TEST(LightTree, SecondRepresentativesAreThoseOfAChild) {
  const MixedLights lights(120, 8);
  const LightTree tree(lights, 1);
  for (const Node node : all_nodes(tree)) {
    const matrix::Index own = tree.redrawn(node, 7).column;
    if (tree.is_leaf(node))
      EXPECT_EQ(own, tree.representative(node));
    else
      EXPECT_TRUE(own == tree.redrawn(tree.left(node), 7).column ||
                  own == tree.redrawn(tree.right(node), 7).column);
  }
}

TEST(LightTree, OfNothingIsEmpty) {
  const matrix::DenseMatrix dark(3, 2, std::vector<Rgb>(6, Rgb(0)));
  const LightTree tree(dark, 1);
  EXPECT_TRUE(tree.roots().empty());
  EXPECT_EQ(tree.leaves(), 0u);
}

}  // namespace
}  // namespace lumirank::methods
