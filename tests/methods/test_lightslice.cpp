// LightSlice: its estimate's expectation, and that it ends at the exact sums.
#include <gtest/gtest.h>

#include "matrix/metered_matrix.h"
#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/method.h"
#include "methods/unbiasedness.h"

namespace lumirank::methods {
namespace {

using Settings = std::map<std::string, std::string>;

Estimate run_lightslice(const matrix::LightingMatrix& m, const Settings& settings, std::uint64_t seed = 1) {
  RunOptions options;
  options.seed = seed;
  return find_method("lightslice").make(settings)->run(m, options);
}

// The mean over seeds of the relative error.
double mean_error(const matrix::DenseMatrix& m, const Settings& settings) {
  double sum = 0;
  constexpr std::uint64_t kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
    sum += relative_l1_difference(run_lightslice(m, settings, seed).sums, m.exact_sums());
  return sum / kSeeds;
}

TEST(LightSlice, ConvergesToAllColumns) {
  const auto m = matrix::sparse_matrix({600, 400, 1}, 0.4);
  double last = 1e9;
  for (const char* columns : {"25", "100", "300"}) {
    const double error = mean_error(m, {{"slice-rows", "50"}, {"columns", columns}});
    EXPECT_LT(error, last) << columns;
    last = error;
  }
  // Each entry is rounded when it is added: 400 additions.
  EXPECT_LT(mean_error(m, {{"slice-rows", "50"}, {"columns", "400"}}), 400 * 0x1p-24);
}

// Columns within a slice of a smooth matrix are nearly parallel where those of the whole matrix are not.
TEST(LightSlice, AdaptsToSlices) {
  const auto m = matrix::low_rank_matrix({800, 400, 1}, 12);
  const double whole = mean_error(m, {{"slice-rows", "800"}, {"neighbors", "1"}, {"columns", "20"}});
  const double sliced = mean_error(m, {{"slice-rows", "50"}, {"neighbors", "4"}, {"columns", "20"}});
  EXPECT_LT(sliced, 0.5 * whole);
}

// 11 two-sided t-tests at a joint confidence of 99.9 %.
TEST(LightSlice, IsUnbiasedWithoutBoundsAndColorAveraging) {
  for (const auto& m :
       {matrix::low_rank_matrix({200, 300, 1}, 8), matrix::sparse_matrix({200, 300, 1}, 0.3)}) {
    test::UnbiasednessTest t(m.exact_sums(), 10);
    for (std::uint64_t seed = 1; seed <= test::runs(150); ++seed)
      t.add(run_lightslice(m,
                           {{"columns", "40"},
                            {"slice-rows", "40"},
                            {"neighbors", "3"},
                            {"drawings", "3"},
                            {"color", "scalar"},
                            {"max-sum-share", "0"},
                            {"zero-columns", "sample"},
                            {"zero-share", "0.3"}},
                           seed)
                .sums);
    EXPECT_LT(t.max_t(), t.limit());
  }
}

// What a representative errs by is shared by the rows that have it. With drawings neighbors have others: over
// seeds their errors go together a good deal less, and each is as large as before.
TEST(LightSlice, DrawingsMakeErrorsOfNeighborsDiffer) {
  auto m = matrix::sparse_matrix({200, 300, 1}, 0.3);
  m.pixel.clear();  // each row is a pixel of its own
  const auto exact = m.exact_sums();
  const auto together = [&](const char* drawings) {
    double product = 0, square = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const auto sums =
          run_lightslice(
              m, {{"columns", "40"}, {"slice-rows", "100"}, {"color", "scalar"}, {"drawings", drawings}},
              seed)
              .sums;
      for (std::size_t i = 0; i + 1 < sums.size(); ++i) {
        const double here = mean(sums[i] - exact[i]), next = mean(sums[i + 1] - exact[i + 1]);
        product += here * next, square += here * here;
      }
    }
    return std::pair{product / square, square};
  };
  const auto [one, error_of_one] = together("1");
  const auto [eight, error_of_eight] = together("8");
  EXPECT_GT(one, 0.5);
  EXPECT_LT(std::abs(eight), 0.2 * one);
  EXPECT_NEAR(error_of_eight / error_of_one, 1, 0.25);
}

TEST(LightSlice, StatesWhatItCost) {
  const auto m = matrix::low_rank_matrix({400, 900, 1}, 5);
  const matrix::MeteredMatrix metered(m);
  const Estimate e = run_lightslice(metered, {{"slice-rows", "100"}, {"columns", "30"}});
  const auto& n = e.trace.numbers;
  EXPECT_EQ(n.at("slices"), 4);
  EXPECT_EQ(n.at("columns"), 30);
  // 4 whole rows, and 30 of 900 columns.
  EXPECT_DOUBLE_EQ(n.at("sampling_rate"), 4.0 / 400 + 30.0 / 900);
  EXPECT_DOUBLE_EQ(static_cast<double>(metered.total().entries), n.at("sampling_rate") * 400 * 900);
}

}  // namespace
}  // namespace lumirank::methods
