#include <gtest/gtest.h>

#include "methods/cut_matrices.h"
#include "methods/stochastic_lightcuts/light_walk.h"
#include "methods/unbiasedness.h"

namespace lumirank::methods {
namespace {

using matrix::DenseMatrix;
using matrix::Index;

Estimate run_stochastic(const DenseMatrix& m, const std::map<std::string, std::string>& settings,
                        std::uint64_t seed) {
  RunOptions options;
  options.seed = seed;
  return find_method("stochastic-lightcuts").make(settings)->run(m, options);
}

// 11 two-sided t-tests at a joint confidence of 99.9 %.
TEST(StochasticLightcuts, AreUnbiased) {
  for (const DenseMatrix& m : test::cut_matrices())
    for (const std::map<std::string, std::string>& settings :
         {std::map<std::string, std::string>{{"nodes", "1"}},
          {{"nodes", "25"}},
          {{"nodes", "120"}, {"error-bound", "0.03"}}}) {
      test::UnbiasednessTest t(m.exact_sums(), 10);
      for (std::uint64_t seed = 1; seed <= test::runs(150); ++seed)
        t.add(run_stochastic(m, settings, seed).sums);
      EXPECT_LT(t.max_t(), t.limit());
    }
}

TEST(StochasticLightcuts, ErrorFallsToNothingAsCutsGrow) {
  test::expect_error_falls_to_nothing("stochastic-lightcuts", {}, "nodes", {"5", "75", "300"});
}

TEST(StochasticLightcuts, AnErrorBoundSavesColumns) {
  const DenseMatrix m = matrix::low_rank_matrix({120, 300, 1}, 6);
  const auto columns = [&](const char* bound) {
    return run_stochastic(m, {{"nodes", "200"}, {"error-bound", bound}}, 1).trace.numbers.at("columns");
  };
  EXPECT_EQ(columns("0"), 200);
  EXPECT_LT(columns("0.05"), columns("0.01"));
  EXPECT_LT(columns("0.01"), 200);
}

// The frequencies of columns are the stated probabilities: chi-square over 20000 walks from the root, which
// passes in 99.9 % of cases.
TEST(StochasticLightcuts, WalksHaveTheStatedProbabilities) {
  const DenseMatrix m = matrix::low_rank_matrix({10, 80, 4}, 6);
  const LightTree tree(m, 1);
  ASSERT_EQ(tree.roots().size(), 1u);
  const auto bounds = m.row_bounds();
  const Index row = 3;
  bounds->set_rows({&row, 1});
  LightWalk walk(tree);
  walk.begin(*bounds);
  const int walks = 20000;
  std::vector<DrawnColumn> drawn;
  Rng rng(1, Stage::test);
  for (int k = 0; k < walks; ++k) walk.draw([&] { return unit_double(rng.next_bits()); }, drawn);
  ASSERT_EQ(drawn.size(), static_cast<std::size_t>(walks));
  std::vector<double> seen(m.columns(), 0), expected(m.columns(), 0);
  for (const DrawnColumn& d : drawn) {
    ++seen[d.column];
    expected[d.column] = walks * static_cast<double>(d.probability);
  }
  lumirank::test::ChiSquareTest chi2;
  double all = 0;
  for (std::size_t j = 0; j < m.columns(); ++j) all += expected[j], chi2.add(seen[j], expected[j]);
  EXPECT_GT(all, 0.99 * walks);
  EXPECT_GT(chi2.tail(), 1e-3);
}

}  // namespace
}  // namespace lumirank::methods
