#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "base/parallel.h"
#include "base/random.h"
#include "matrix/block_diagonal.h"
#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/common/row_group_pass.h"
#include "methods/multidimensional_lightcuts/gather_tree.h"
#include "methods/multidimensional_lightcuts/pair_cut.h"
#include "support/statistics.h"

namespace lumirank::methods {
namespace {

using matrix::DenseMatrix;
using matrix::Index;

// Weights between 0 and 2, some of them 0; places and normals anywhere.
void add_features(DenseMatrix& m) {
  for (std::size_t i = 0; i < m.rows(); ++i) {
    Rng rng(7, Stage::test, 200, i);
    const float x = rng.next_float(), y = rng.next_float(), z = rng.next_float();
    m.row_position.push_back({x, y, z});
    m.row_normal.push_back(normalize(Vec3f{x - 0.5f, y - 0.5f, z + 0.1f}));
    m.row_weight.push_back(i % 7 == 3 ? 0.0f : 2 * rng.next_float());
  }
}

std::vector<DenseMatrix> matrices() {
  std::vector<DenseMatrix> m;
  m.push_back(matrix::low_rank_matrix({160, 300, 1}, 6, 3));
  m.push_back(matrix::sparse_matrix({160, 300, 2}, 0.3));
  m.push_back(matrix::recess_matrix({160, 300, 3}));
  for (DenseMatrix& one : m) {
    add_features(one);
    for (Vec2f& p : one.pixel) p = {p.x / 2, p.y / 2};  // eight rows to a pixel
  }
  return m;
}

// What the picture shows: sums times weights, by pixel.
std::vector<Rgb> pixel_sums(const DenseMatrix& m, std::span<const Rgb> sums) {
  const RowGroups pixels = RowGroups::pixels(m);
  std::vector<Rgb> out(pixels.size());
  for (std::size_t p = 0; p < pixels.size(); ++p)
    for (const Index i : pixels[p]) out[p] += sums[i] * m.row_weight[i];
  return out;
}

TEST(MultidimensionalLightcuts, WithoutBoundAndLimitEqualBruteForce) {
  for (const DenseMatrix& m : matrices()) {
    const Estimate e = find_method("multidimensional-lightcuts")
                           .make({{"error-bound", "0"}, {"max-pairs", "1000000"}})
                           ->run(m, {});
    EXPECT_LT(relative_difference(pixel_sums(m, e.sums), pixel_sums(m, m.exact_sums())), 1e-6);
    // Row by row as well, where the row has any weight.
    for (std::size_t i = 0; i < m.rows(); ++i) {
      if (m.row_weight[i] > 0) {
        EXPECT_LT(norm2(e.sums[i] - m.exact_sums()[i]), 1e-5f * norm2(m.exact_sums()[i])) << i;
      }
    }
  }
}

TEST(MultidimensionalLightcuts, ErrorFallsToNothingAsCutsGrow) {
  for (const DenseMatrix& m : matrices()) {
    std::vector<double> errors;
    for (const char* pairs : {"10", "300", "10000"}) {
      const Estimate e = find_method("multidimensional-lightcuts")
                             .make({{"error-bound", "0"}, {"max-pairs", pairs}})
                             ->run(m, {});
      errors.push_back(relative_difference(pixel_sums(m, e.sums), pixel_sums(m, m.exact_sums())));
      EXPECT_LE(e.trace.numbers.at("columns_max"), std::stod(pairs));
    }
    EXPECT_GT(errors[0], errors[1]);
    EXPECT_GT(errors[1], errors[2]);
    EXPECT_LT(errors[2], 1e-6);
  }
}

// Receivers of a pixel that are one and the same: one of them answers for all, exactly.
TEST(MultidimensionalLightcuts, AlikeReceiversCostAsMuchAsOne) {
  constexpr std::size_t kColumns = 40, kSame = 6;
  std::vector<Rgb> entries;
  for (std::size_t i = 0; i < kSame; ++i)
    for (std::size_t j = 0; j < kColumns; ++j) entries.emplace_back(static_cast<float>(j + 1));
  DenseMatrix m(kSame, kColumns, std::move(entries));
  m.pixel.assign(kSame, {0.5f, 0.5f});
  m.row_position.assign(kSame, {1, 2, 3});
  m.row_normal.assign(kSame, {0, 0, 1});
  m.column_position.resize(kColumns);
  for (std::size_t j = 0; j < kColumns; ++j) m.column_position[j].x = static_cast<float>(j);
  const LightTree lights(m, 1);
  PairCut cut(lights, nullptr, GatherTree(m, 1, 1), {0, kColumns, 4});
  std::vector<Index> rows(kSame);
  std::iota(rows.begin(), rows.end(), 0u);
  cut.begin(rows);
  std::vector<std::uint32_t> places;
  std::vector<Index> columns;
  while (cut.request(0, places, columns)) {
    std::vector<Rgb> values;
    for (std::size_t k = 0; k < columns.size(); ++k)
      values.push_back(m.at(cut.rows()[places[k]], columns[k]));
    cut.take(values);
    places.clear(), columns.clear();
  }
  std::vector<Rgb> sums(kSame);
  cut.write_sums(sums);
  // Lights lie apart and receivers do not, so all pairs are the whole pixel with one light each.
  EXPECT_EQ(cut.size(), kColumns);
  for (const Rgb s : sums) EXPECT_EQ(s, Rgb(kColumns * (kColumns + 1) / 2));
}

// Four instants of a scene that moves: other entries at each, places that drift, pixels that have rows at all
// of them.
matrix::BlockDiagonal instants() {
  std::vector<std::shared_ptr<const matrix::LightingMatrix>> blocks;
  for (std::uint64_t t = 0; t < 4; ++t) {
    auto m = std::make_shared<DenseMatrix>(matrix::occluded_matrix({60, 80, 5 + t}, 2 + t));
    const auto shift = static_cast<float>(t);
    for (std::size_t i = 0; i < m->rows(); ++i) {
      m->row_position[i].x += 0.05f * shift;
      m->row_weight.push_back(i % 9 == 4 ? 0.0f : 0.5f + 0.1f * static_cast<float>(i % 5));
    }
    blocks.push_back(std::move(m));
  }
  return matrix::BlockDiagonal(std::move(blocks));
}

std::vector<double> luminances_of_pixels(const matrix::LightingMatrix& m, std::span<const Rgb> sums) {
  const RowGroups pixels = RowGroups::pixels(m);
  std::vector<double> out(pixels.size());
  for (std::size_t p = 0; p < pixels.size(); ++p)
    for (const Index i : pixels[p])
      out[p] += static_cast<double>(luminance(sums[i] * m.row_features().weight[i]));
  return out;
}

TEST(MultidimensionalLightcuts, OverInstantsConvergeToBruteForce) {
  const matrix::BlockDiagonal m = instants();
  const Estimate exact = find_method("brute-force").make({})->run(m, {});
  const auto wanted = luminances_of_pixels(m, exact.sums);
  std::vector<double> errors;
  for (const char* pairs : {"10", "100", "600", "1000000"}) {
    const Estimate e = find_method("multidimensional-lightcuts")
                           .make({{"error-bound", "0"}, {"max-pairs", pairs}})
                           ->run(m, {});
    EXPECT_LE(e.trace.numbers.at("columns_max"), std::stod(pairs));
    const auto have = luminances_of_pixels(m, e.sums);
    double off = 0, all = 0;
    for (std::size_t p = 0; p < have.size(); ++p) off += std::abs(have[p] - wanted[p]), all += wanted[p];
    errors.push_back(off / all);
    // A row is lit by its own instant's columns alone, 80 of 320; pairs of others are never made.
    if (std::string(pairs) == "1000000") {
      EXPECT_LE(e.trace.numbers.at("columns"), 80);
      for (std::size_t i = 0; i < m.rows(); ++i)
        if (m.row_features().weight[i] > 0) {
          EXPECT_LT(norm2(e.sums[i] - exact.sums[i]), 1e-5f * norm2(exact.sums[i]) + 1e-12f) << i;
        }
    }
  }
  for (std::size_t k = 1; k < errors.size(); ++k) EXPECT_LT(errors[k], errors[k - 1]) << k;
  EXPECT_LT(errors.back(), 1e-5);
}

// The coarsest cut of all is a draw of an instant, a row and a column, whose mean is the sum: over 3000
// seeds, each pixel within an interval that holds for all of them in 99.9 % of cases.
TEST(MultidimensionalLightcuts, OneOfAllPairsOverInstantsIsUnbiased) {
  constexpr std::size_t kRows = 4, kColumns = 5;
  std::vector<std::shared_ptr<const matrix::LightingMatrix>> blocks;
  for (std::uint64_t t = 0; t < 3; ++t) {
    std::vector<Rgb> entries;
    for (std::size_t k = 0; k < kRows * kColumns; ++k) {
      Rng rng(t, Stage::test, 300, k);
      entries.emplace_back(rng.next_float());
    }
    DenseMatrix m(kRows, kColumns, std::move(entries));
    for (std::size_t i = 0; i < kRows; ++i) {
      m.pixel.push_back({i < 2 ? 0.5f : 1.5f, 0.5f});
      m.row_weight.push_back(0.3f + 0.2f * static_cast<float>(i + t));
      m.row_position.push_back({static_cast<float>(i), 0, 0}), m.row_normal.push_back({0, 0, 1});
    }
    for (std::size_t j = 0; j < kColumns; ++j) {
      m.power.push_back(0.2f + static_cast<float>((j * 3 + t) % 5));
      m.column_position.push_back({static_cast<float>(j), 1, 0});
    }
    blocks.push_back(std::make_shared<DenseMatrix>(std::move(m)));
  }
  const matrix::BlockDiagonal m(std::move(blocks));
  const auto wanted = luminances_of_pixels(m, find_method("brute-force").make({})->run(m, {}).sums);
  std::vector<lumirank::test::RunningMean> means(wanted.size());
  const auto method = find_method("multidimensional-lightcuts").make({{"max-pairs", "1"}});
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    RunOptions options;
    options.seed = seed;
    const auto have = luminances_of_pixels(m, method->run(m, options).sums);
    for (std::size_t p = 0; p < have.size(); ++p) means[p].add(have[p]);
  }
  for (std::size_t p = 0; p < means.size(); ++p) {
    EXPECT_GT(means[p].standard_error(), 0.001 * wanted[p]);  // it is a draw
    EXPECT_NEAR(means[p].mean(), wanted[p],
                lumirank::test::normal_quantile(1e-3, means.size()) * means[p].standard_error());
  }
}

TEST(MultidimensionalLightcuts, OverInstantsTheSameBitsOnAnyNumberOfThreads) {
  const matrix::BlockDiagonal m = instants();
  const auto method = find_method("multidimensional-lightcuts").make({{"max-pairs", "100"}});
  std::vector<Rgb> first;
  for (const int threads : {1, 2, 5}) {
    with_threads(threads, [&] {
      const auto sums = method->run(m, {}).sums;
      if (first.empty()) first = sums;
      EXPECT_EQ(sums, first);
    });
  }
}

TEST(GatherTree, NodesHoldTheirRowsWeightsAndRepresentatives) {
  DenseMatrix m(37, 1, std::vector<Rgb>(37, Rgb(1)));
  add_features(m);
  std::vector<Index> rows(37);
  std::iota(rows.begin(), rows.end(), 0u);
  GatherTree tree(m, 1, 0.5f);
  for (int again = 0; again < 2; ++again) {
    tree.build(rows);
    EXPECT_EQ(std::set<Index>(tree.order().begin(), tree.order().end()).size(), 37u);
    std::vector<GatherTree::Node> stack{GatherTree::root()};
    std::size_t leaves = 0;
    while (!stack.empty()) {
      const GatherTree::Node node = stack.back();
      stack.pop_back();
      const std::uint32_t chosen = tree.representative(node);
      EXPECT_TRUE(chosen >= tree.begin(node) && chosen < tree.end(node));
      float weight = 0;
      for (std::uint32_t k = tree.begin(node); k < tree.end(node); ++k)
        weight += m.row_weight[tree.order()[k]];
      EXPECT_NEAR(tree.weight(node), weight, 1e-5f);
      if (tree.is_leaf(node)) {
        EXPECT_EQ(tree.end(node) - tree.begin(node), 1u);
        EXPECT_EQ(tree.extent(node), 0);
        ++leaves;
        continue;
      }
      EXPECT_GT(tree.extent(node), 0);
      const auto left = tree.left(node), right = tree.right(node);
      EXPECT_TRUE(chosen == tree.representative(left) || chosen == tree.representative(right));
      EXPECT_EQ(tree.begin(left), tree.begin(node));
      EXPECT_EQ(tree.end(left), tree.begin(right));
      EXPECT_EQ(tree.end(right), tree.end(node));
      stack.push_back(left), stack.push_back(right);
    }
    EXPECT_EQ(leaves, 37u);
  }
}

// Drawn in proportion to weight: over 4000 seeds, the counts of a tree's five rows pass a chi-square test
// that fair ones pass in 99.9 % of cases.
TEST(GatherTree, RepresentativesAreDrawnByWeight) {
  DenseMatrix m(5, 1, std::vector<Rgb>(5, Rgb(1)));
  m.row_weight = {1, 2, 3, 4, 10};
  const std::vector<Index> rows{0, 1, 2, 3, 4};
  constexpr int kSeeds = 4000;
  std::vector<double> count(5);
  for (int seed = 0; seed < kSeeds; ++seed) {
    GatherTree tree(m, static_cast<std::uint64_t>(seed), 1);
    tree.build(rows);
    ++count[tree.order()[tree.representative(GatherTree::root())]];
  }
  lumirank::test::ChiSquareTest chi2;
  for (std::size_t i = 0; i < 5; ++i) chi2.add(count[i], kSeeds * static_cast<double>(m.row_weight[i]) / 20);
  EXPECT_GT(chi2.tail(), 1e-3);
}

}  // namespace
}  // namespace lumirank::methods
