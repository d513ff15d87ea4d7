// Adaptive column sampling and completion on matrices whose structure is known.
#include <gtest/gtest.h>

#include "matrix/synthetic.h"
#include "methods/column_completion/column_tree.h"
#include "methods/column_completion/completion_slices.h"
#include "methods/common/column_pass.h"
#include "methods/method.h"
#include "methods/unbiasedness.h"

namespace lumirank::methods {
namespace {

Estimate complete(const matrix::LightingMatrix& m, const std::map<std::string, std::string>& settings,
                  std::uint64_t seed = 1) {
  RunOptions options;
  options.seed = seed;
  return find_method("column-completion").make(settings)->run(m, options);
}

TEST(ColumnCompletion, ConvergesToAllColumns) {
  const auto m = matrix::occluded_matrix({600, 2000, 3}, 8);
  const auto exact = m.exact_sums();
  double before = 1;
  for (const char* tolerance : {"0.1", "0.01", "0.001", "0"}) {
    const auto e = complete(m, {{"beta", tolerance}, {"sigma", tolerance}, {"slice-rows", "200"}});
    const double error = relative_l1_difference(e.sums, exact);
    EXPECT_LT(error, before) << tolerance;
    before = error;
  }
  EXPECT_LT(before, 1e-5);
}

// Of a matrix of rank 6 in each of three channels, which are stacked, and 4,000 columns: no more than 18
// columns are sampled wholly in each slice, and of the others a few rows.
TEST(ColumnCompletion, KnowsColumnsOfLowRankByFewRows) {
  const auto m = matrix::low_rank_matrix({2000, 4000, 1}, 6);
  const auto e = complete(m, {{"slice-rows", "500"}, {"beta", "0.003"}});
  EXPECT_LT(relative_l1_difference(e.sums, m.exact_sums()), 0.02);
  EXPECT_LE(e.trace.numbers.at("completion.max_rank"), 18);
  EXPECT_LT(e.trace.numbers.at("completion.rows_sampled"), 100);
  EXPECT_LT(e.trace.numbers.at("sampling_rate"), 0.05);
}

// Decisions hang on what was drawn, so the estimate is not exactly unbiased; what is left is far below its
// noise.
TEST(ColumnCompletion, HasHardlyAnyBias) {
  const auto m = matrix::low_rank_matrix({300, 1500, 1}, 6);
  double error = 0, bias = 0, total = 0;
  const auto exact = m.exact_sums();
  std::vector<double> mean(m.rows(), 0.0);
  constexpr int kRuns = 60;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const auto sums = complete(m, {{"beta", "0.02"}}, seed).sums;
    error += relative_l1_difference(sums, exact) / kRuns;
    for (std::size_t i = 0; i < m.rows(); ++i) mean[i] += static_cast<double>(luminance(sums[i])) / kRuns;
  }
  for (std::size_t i = 0; i < m.rows(); ++i) {
    bias += mean[i] - static_cast<double>(luminance(exact[i]));
    total += static_cast<double>(luminance(exact[i]));
  }
  EXPECT_LT(std::abs(bias / total), 0.5 * error) << error;
}

TEST(ColumnTree, DrawsInProportionToPowerAndChildrenShareThem) {
  const auto m = matrix::low_rank_matrix({10, 400, 2}, 3);
  constexpr std::size_t kDraws = 50;
  std::vector<double> drawn(m.columns(), 0.0);
  double total = 0;
  for (std::size_t j = 0; j < m.columns(); ++j) total += static_cast<double>(m.column_features().power[j]);
  constexpr int kTrees = 200;
  for (std::uint64_t seed = 1; seed <= kTrees; ++seed) {
    const ColumnTree tree(m, kDraws, seed);
    ASSERT_EQ(tree.roots().size(), 1u);
    const auto root = tree.roots()[0].node;
    for (const matrix::Index j : tree.drawn(root)) drawn[j] += 1;
    const auto left = tree.drawn(tree.left(root)), right = tree.drawn(tree.right(root));
    for (std::size_t k = 0; k < kDraws; ++k)
      EXPECT_TRUE(tree.drawn(root)[k] == left[k] || tree.drawn(root)[k] == right[k]);
  }
  double chi2 = 0, columns = 0;
  for (std::size_t j = 0; j < m.columns(); ++j) {
    const double expected = kTrees * kDraws * static_cast<double>(m.column_features().power[j]) / total;
    if (expected < 5) continue;
    chi2 += (drawn[j] - expected) * (drawn[j] - expected) / expected, columns += 1;
  }
  ASSERT_GT(columns, 50);
  EXPECT_LT(chi2, columns + 4 * std::sqrt(2 * columns));
}

// One work space for all of them, whatever their sizes.
TEST(ColumnCompletion, SlicesKnowNothingOfEachOther) {
  const auto m = matrix::occluded_matrix({500, 300, 3}, 8);
  const auto all = complete(m, {{"slice-rows", "500"}}).sums;
  class Halved final : public matrix::DenseMatrix {
   public:
    explicit Halved(matrix::DenseMatrix m) : DenseMatrix(std::move(m)) {
      // A large slice before small ones.
      for (std::uint32_t i = 0; i < rows(); ++i) slices_.push_back(i < 380 ? 0 : 1 + i / 40);
    }
    matrix::RowFeatures row_features() const override {
      auto f = DenseMatrix::row_features();
      f.slice = slices_;
      return f;
    }

   private:
    std::vector<std::uint32_t> slices_;
  };
  const auto exact = m.exact_sums();
  EXPECT_LT(
      relative_l1_difference(complete(Halved(matrix::occluded_matrix({500, 300, 3}, 8)), {}).sums, exact),
      0.1);
  EXPECT_LT(relative_l1_difference(all, exact), 0.1);
}

TEST(CompletionSlices, KeepsThoseThatWereGiven) {
  matrix::RowFeatures f{};
  const std::vector<Vec3f> places(9, Vec3f{});
  const std::vector<std::uint32_t> given{matrix::kNoSlice, 7, 3, 7, 3, matrix::kNoSlice, 3,
                                         matrix::kNoSlice, 7};
  f.position = places, f.slice = given;
  const Slices slices = completion_slices(f, 9, 2, RowPartition::given);
  ASSERT_EQ(slices.count(), 4u);
  std::vector<std::vector<matrix::Index>> own;
  for (std::size_t s = 0; s < 4; ++s) own.emplace_back(slices.slice(s).begin(), slices.slice(s).end());
  EXPECT_EQ(own[2], (std::vector<matrix::Index>{2, 4, 6}));
  EXPECT_EQ(own[3], (std::vector<matrix::Index>{1, 3, 8}));
  EXPECT_EQ(own[0].size() + own[1].size(), 3u);
}

}  // namespace
}  // namespace lumirank::methods
