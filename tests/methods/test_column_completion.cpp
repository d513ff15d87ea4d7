// Adaptive column sampling and completion on matrices whose structure is known.
#include <gtest/gtest.h>

#include <numeric>

#include "matrix/synthetic.h"
#include "methods/column_completion/column_draws.h"
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

// Of a matrix of rank 6 in each of three channels, which are stacked, and 4,000 columns: about 18 columns
// (some more by rounding) are sampled wholly in each slice, and of the others a few rows.
TEST(ColumnCompletion, KnowsColumnsOfLowRankByFewRows) {
  const auto m = matrix::low_rank_matrix({2000, 4000, 1}, 6);
  const auto e = complete(m, {{"slice-rows", "500"}, {"beta", "0.003"}});
  EXPECT_LT(relative_l1_difference(e.sums, m.exact_sums()), 0.03);
  EXPECT_LE(e.trace.numbers.at("completion.max_rank"), 24);
  EXPECT_LT(e.trace.numbers.at("completion.rows_sampled"), 100);
  EXPECT_LT(e.trace.numbers.at("sampling_rate"), 0.08);
}

// Nodes that seem well known are left whole, and what completion leaves out of a column is not estimated, so
// there is a bias; it is below the error of a single run.
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
  EXPECT_LT(std::abs(bias / total), 0.75 * error) << error;
}

// Every column is drawn as often as its probability says, which adds up to 1, and walks go left as often as
// they say.
void expect_draws_as_foretold(std::size_t asked) {
  const auto m = matrix::occluded_matrix({10, 200, 2}, 3);
  const ColumnTree tree(m, 4, 16);
  ASSERT_EQ(tree.roots().size(), 1u);
  const auto root = tree.roots()[0].node;
  std::vector<matrix::Index> rows(10);
  std::iota(rows.begin(), rows.end(), matrix::Index{0});
  const auto reader = m.reader();
  reader->set_rows(rows);
  Rng rng(1, Stage::test);
  ColumnDraws draws(tree, m.row_features(), asked);
  EXPECT_EQ(draws.begin(rows, *reader, rng), asked * tree.coarse_cut().size());
  std::vector<double> drawn(200, 0.0), probability(200, 0.0);
  constexpr int kDraws = 100000;
  int to_left = 0;
  for (int k = 0; k < kDraws; ++k) {
    const auto d = draws.draw(root, rng);
    drawn[d.place] += 1, probability[d.place] = d.probability;
    to_left += tree.holds(tree.left(root), d.place);
  }
  double chi2 = 0, seen = 0, sum = 0;
  for (std::size_t j = 0; j < 200; ++j) {
    sum += probability[j];
    const double expected = kDraws * probability[j];
    if (expected < 5) continue;
    chi2 += (drawn[j] - expected) * (drawn[j] - expected) / expected, seen += 1;
  }
  EXPECT_NEAR(sum, 1, 1e-3);
  ASSERT_GT(seen, 100);
  EXPECT_LT(chi2, seen + 4 * std::sqrt(2 * seen));
  EXPECT_NEAR(static_cast<double>(to_left) / kDraws, draws.left_probability(root), 0.01);
}

TEST(ColumnDraws, ByPowerAndDistanceAreAsForetold) { expect_draws_as_foretold(0); }
TEST(ColumnDraws, ByWhatRowsGetAreAsForetold) { expect_draws_as_foretold(3); }

// A tenth of the columns, behind one another on one side, are all that is seen; half of the walks and more go
// there once rows were asked, and a tenth before.
TEST(ColumnDraws, GoWhereRowsGetLight) {
  constexpr std::size_t kRows = 8, kColumns = 400, kSeen = 40;
  std::vector<Rgb> entries(kRows * kColumns, Rgb(1));
  std::vector<float> visible(kRows * kColumns, 0.0f);
  for (std::size_t i = 0; i < kRows; ++i)
    std::fill_n(visible.begin() + static_cast<std::ptrdiff_t>(i * kColumns), kSeen, 1.0f);
  matrix::DenseMatrix m(kRows, kColumns, entries, visible);
  m.power.assign(kColumns, 1.0f);
  for (std::size_t i = 0; i < kRows; ++i)
    m.row_position.push_back({0.0f, 0.0f, 0.1f * static_cast<float>(i)});
  // On a circle around the rows, so that distance tells nothing.
  for (std::size_t j = 0; j < kColumns; ++j) {
    const float angle = 6.2831853f * static_cast<float>(j) / kColumns;
    m.column_position.push_back({50 * std::cos(angle), 50 * std::sin(angle), 0.0f});
  }
  const ColumnTree tree(m, 4, 64);
  std::vector<matrix::Index> rows(kRows);
  std::iota(rows.begin(), rows.end(), matrix::Index{0});
  const auto reader = m.reader();
  reader->set_rows(rows);
  const auto share = [&](std::size_t asked) {
    Rng rng(1, Stage::test);
    ColumnDraws draws(tree, m.row_features(), asked);
    draws.begin(rows, *reader, rng);
    int seen = 0;
    constexpr int kDraws = 4000;
    for (int k = 0; k < kDraws; ++k) seen += tree.column(draws.draw(tree.roots()[0].node, rng).place) < kSeen;
    return static_cast<double>(seen) / kDraws;
  };
  EXPECT_LT(share(0), 0.2);
  EXPECT_GT(share(2), 0.45);
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

// Two clumps whose rows alternate, given as slices by number: clusters know them apart.
TEST(CompletionSlices, ClustersByPlace) {
  matrix::RowFeatures f{};
  std::vector<Vec3f> places;
  std::vector<std::uint32_t> given;
  for (std::uint32_t i = 0; i < 40; ++i) {
    places.push_back({static_cast<float>(10 * (i % 2)) + 0.01f * static_cast<float>(i), 0.0f, 0.0f});
    given.push_back(i / 20);
  }
  f.position = places, f.slice = given;
  const Slices slices = completion_slices(f, 40, 64, RowPartition::k_means);
  ASSERT_EQ(slices.count(), 2u);
  for (std::size_t s = 0; s < 2; ++s) {
    const auto rows = slices.slice(s);
    ASSERT_EQ(rows.size(), 20u);
    for (const matrix::Index i : rows) EXPECT_EQ(i % 2, rows[0] % 2);
  }
}

}  // namespace
}  // namespace lumirank::methods
