#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "matrix/synthetic.h"
#include "methods/common/column_clusters.h"
#include "methods/common/column_pass.h"
#include "methods/parameters.h"
#include "methods/unbiasedness.h"

namespace lumirank::methods {
namespace {

Estimate run_row_column(const matrix::LightingMatrix& m, const SettingsMap& settings,
                        const RunOptions& options = {}) {
  return find_method("row-column-sampling").make(settings)->run(m, options);
}

// As many clusters as directions, and one color per direction: every representative is its cluster's sum up
// to rounding. A column's entry carries about six roundings, its norm over 50 rows 25 more.
TEST(RowColumn, ExactClustersGiveTheExactSum) {
  const auto m = matrix::clustered_matrix({300, 400, 1}, 12);
  for (const char* clustering : {"combined", "splitting"})
    for (const char* color : {"averaged", "scalar"}) {
      const Estimate e = run_row_column(
          m, {{"rows", "50"}, {"columns", "12"}, {"clustering", clustering}, {"color", color}});
      EXPECT_EQ(e.trace.numbers.at("columns"), 12);
      EXPECT_LT(relative_difference(e.sums, m.exact_sums()), 64 * 0x1p-24);
    }
}

TEST(RowColumn, AllColumnsAreExact) {
  const auto m = matrix::low_rank_matrix({300, 200, 1}, 10);
  const Estimate e = run_row_column(m, {{"rows", "50"}, {"columns", "200"}});
  EXPECT_LT(relative_difference(e.sums, m.exact_sums()), 200 * 0x1p-24);
}

// Mean squared errors over 20 seeds fall with the number of columns, by a one-sided test of the difference at
// 99.9 % each. By the paper's probabilities: where the rank is low the norms are as good as known, and a
// share of power only adds noise.
TEST(RowColumn, ErrorFallsWithColumns) {
  const auto m = matrix::low_rank_matrix({500, 1000, 1}, 15);
  const auto truth = m.exact_sums();
  std::vector<double> previous;
  for (const char* columns : {"10", "30", "90", "270"}) {
    std::vector<double> squares;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      RunOptions options;
      options.seed = seed;
      const double e = relative_difference(
          run_row_column(
              m, {{"rows", "100"}, {"columns", columns}, {"power-share", "0"}, {"row-weights", "light"}},
              options)
              .sums,
          truth);
      squares.push_back(e * e);
    }
    if (!previous.empty()) {
      double mean = 0, variance = 0;
      for (std::size_t k = 0; k < 20; ++k) mean += (previous[k] - squares[k]) / 20;
      for (std::size_t k = 0; k < 20; ++k) variance += std::pow(previous[k] - squares[k] - mean, 2) / 19;
      EXPECT_GT(mean / std::sqrt(variance / 20), 3.58) << columns;  // Student's t, 19 degrees of freedom
    }
    previous = squares;
  }
}

// Clusters within groups: the columns chosen for one group sum to that group's total, in expectation; with as
// many clusters as exact directions within groups, exactly.
TEST(RowColumn, GroupsKeepTheirTotals) {
  auto m = matrix::clustered_matrix({200, 300, 1}, 4);
  m.group.resize(300);
  for (std::size_t j = 0; j < 300; ++j) m.group[j] = j < 100 ? 0 : 7;
  ClusterSettings settings;
  settings.color = ColorMode::scalar;
  ReducedMatrix seen(m, {m.columns(), 40, false}, 1);
  std::vector<Rgb> values(m.columns());
  for (const SampledRow& row : RowSampler(m, 1).stratified(40)) seen.read(row, values);
  const ColumnClusters known(m, seen, settings, 1);
  const auto clusters = known.cluster(8, linalg::ClusteringAlgorithm::combined);
  ASSERT_EQ(clusters.clusters(), 8u);
  const Representatives chosen = known.choose(clusters, 0);
  for (std::uint16_t group : {std::uint16_t{0}, std::uint16_t{7}}) {
    double got = 0, expected = 0;
    for (const auto& c : chosen.columns)
      if (m.group[c.column] == group)
        got += static_cast<double>(c.scale.r) * static_cast<double>(m.at(5, c.column).r);
    for (std::size_t j = 0; j < 300; ++j)
      if (m.group[j] == group) expected += static_cast<double>(m.at(5, j).r);
    EXPECT_NEAR(got, expected, 64 * 0x1p-24 * expected);
  }
}

// Squared errors over 400 draws of representatives, against those to expect.
struct Errors {
  double z_seen;                 // (mean − expected) in standard deviations of the mean
  std::vector<double> z_unseen;  // the same, at single rows
  std::size_t zero_columns;
};
Errors errors_over_draws(const matrix::DenseMatrix& colored) {
  // Colorless: scalars are then the entries, up to the factor √3, which cancels.
  std::vector<Rgb> gray(colored.rows() * colored.columns());
  for (std::size_t i = 0; i < colored.rows(); ++i)
    for (std::size_t j = 0; j < colored.columns(); ++j)
      gray[i * colored.columns() + j] = Rgb(colored.at(i, j).g);
  matrix::DenseMatrix m(colored.rows(), colored.columns(), std::move(gray));
  m.power = colored.power;
  ClusterSettings settings;
  settings.color = ColorMode::scalar;
  ReducedMatrix seen(m, {m.columns(), 40, false}, 1);
  std::vector<Rgb> values(m.columns());
  std::vector<HeldOutRows> unseen;  // one row each
  RowSampler sampler(m, 1);
  for (const SampledRow& row : sampler.next(40)) seen.read(row, values);
  for (const SampledRow& row : sampler.next(10)) unseen.emplace_back(m).read(row, values);
  const ColumnClusters known(m, seen, settings, 1);
  const auto clusters = known.cluster(25, linalg::ClusteringAlgorithm::combined);

  const int draws = 400;
  struct Moments {
    double sum = 0, squares = 0;
    void add(double x) { sum += x, squares += x * x; }
    double z(double expected) const {
      const double mean = sum / draws, deviation = std::sqrt((squares / draws - mean * mean) / draws);
      return (mean - expected) / deviation;
    }
  };
  Moments on_seen;
  std::vector<Moments> on_unseen(unseen.size());
  for (int t = 0; t < draws; ++t) {
    const Representatives chosen = known.choose(clusters, static_cast<std::uint64_t>(t));
    std::vector<Rgb> sums(m.rows());
    m.accumulate(chosen.columns, sums);
    const auto error = [&](const ExactRow& row) {
      return static_cast<double>(sums[row.from.row].g) - static_cast<double>(row.sum.g);
    };
    double difference = 0, size = 0;
    for (const ExactRow& row : seen.known().rows()) {
      difference += error(row) * error(row);
      size += static_cast<double>(row.sum.g) * static_cast<double>(row.sum.g);
    }
    on_seen.add(difference / size);
    for (std::size_t k = 0; k < unseen.size(); ++k) {
      const ExactRow& row = unseen[k].known().rows()[0];
      on_unseen[k].add(std::pow(error(row) / static_cast<double>(row.sum.g), 2));
    }
  }
  // An L1 error to expect is a standard deviation times E|normal deviate|; at one row it is nothing else.
  Errors errors;
  errors.z_seen = on_seen.z(std::pow(known.expected_error(clusters) / seen.l1_over_l2(), 2));
  for (std::size_t k = 0; k < unseen.size(); ++k)
    errors.z_unseen.push_back(
        on_unseen[k].z(std::pow(known.expected_error(clusters, unseen[k]) / kMeanOfNormal, 2)));
  errors.zero_columns = known.zero().size();
  return errors;
}

// z-tests at 99.9 %: on the rows that were clustered by (no projection), and on ten others (Bonferroni).
TEST(RowColumn, ExpectedErrorsAreTheMeansOfTheErrors) {
  const Errors e = errors_over_draws(matrix::low_rank_matrix({400, 300, 1}, 12));
  ASSERT_EQ(e.zero_columns, 0u);
  EXPECT_LT(std::abs(e.z_seen), 3.29);
  for (double z : e.z_unseen) EXPECT_LT(std::abs(z), 3.89);
}

// With zero columns: they add nothing on seen rows. Their draws are stratified and so vary less than the
// independent ones that are counted: the error to expect on unseen rows is an upper bound (one-sided, 99.9 %,
// Bonferroni).
TEST(RowColumn, ExpectedErrorsCountZeroColumns) {
  const Errors e = errors_over_draws(matrix::sparse_matrix({400, 300, 1}, 0.1));
  ASSERT_GT(e.zero_columns, 20u);
  EXPECT_LT(std::abs(e.z_seen), 3.29);
  for (double z : e.z_unseen) EXPECT_LT(z, 3.72);
}

// A room beside a stripe of sun: one row in eight has a thousand times the light of the others, by columns of
// its own. As rows count in the paper, columns that the others alone tell apart are as good as equal; by eye
// they decide as much as any. Errors relative to each row's own light, over 10 seeds.
TEST(RowColumn, RowsThatCountByEyeLightTheDark) {
  const auto dim = matrix::low_rank_matrix({400, 300, 1}, 12);
  std::vector<Rgb> entries(dim.rows() * dim.columns());
  for (std::size_t i = 0; i < dim.rows(); ++i)
    for (std::size_t j = 0; j < dim.columns(); ++j)
      entries[i * dim.columns() + j] = i % 8 == 0 ? 1000 * dim.at(i, (7 * j) % dim.columns()) : dim.at(i, j);
  const matrix::DenseMatrix m(dim.rows(), dim.columns(), std::move(entries));
  const auto truth = m.exact_sums();
  struct OfRows {
    double dark = 0, bright = 0, expected_l1 = 0, l1 = 0;
  };
  const auto errors = [&](const char* weights) {
    OfRows e;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      RunOptions options;
      options.seed = seed;
      const Estimate got = run_row_column(
          m, {{"rows", "80"}, {"columns", "30"}, {"row-weights", weights}, {"power-share", "0"}}, options);
      for (std::size_t i = 0; i < m.rows(); ++i)
        (i % 8 == 0 ? e.bright : e.dark) +=
            static_cast<double>(norm2(got.sums[i] - truth[i]) / norm2(truth[i]));
      e.expected_l1 += got.trace.numbers.at("predicted_error_seen");
      e.l1 += relative_l1_difference(got.sums, truth);
    }
    return e;
  };
  const OfRows light = errors("light"), eye = errors("eye");
  EXPECT_LT(eye.dark, 0.5 * light.dark);
  EXPECT_LT(light.bright, eye.bright);
  // What is foretold is the picture's relative L1 error all the same.
  EXPECT_NEAR(eye.expected_l1 / eye.l1, 1, 0.5);
}

TEST(RowSampler, StratifiedRowsAreDistinctAndEqualShares) {
  const auto m = matrix::low_rank_matrix({1003, 2, 1}, 1);
  const RowSampler sampler(m, 1);
  for (std::size_t count : {1u, 10u, 300u, 1003u, 5000u}) {
    const auto rows = sampler.stratified(count);
    std::set<matrix::Index> distinct;
    for (const auto& r : rows) distinct.insert(r.row);
    EXPECT_EQ(rows.size(), std::min<std::size_t>(count, 1003));
    EXPECT_EQ(distinct.size(), rows.size());
  }
  // Σ over blocks of weight² = rows counted with their block's size: number of rows read.
  double squares = 0;
  for (const auto& r : sampler.stratified(300))
    squares += static_cast<double>(r.weight) * static_cast<double>(r.weight);
  EXPECT_NEAR(squares, 300, 300 * 4 * 0x1p-24);
}

// Every row equally likely: chi-square of 2,000 draws (400 under sanitizers) of 10 rows of 50, over 50 rows
// (49 degrees of freedom). Rows of a sample avoid each other, which makes the statistic smaller, never
// larger; 85.4 is exceeded with probability 0.001.
TEST(RowSampler, EveryRowIsEquallyLikely) {
  const auto m = matrix::low_rank_matrix({50, 2, 1}, 1);
  const std::uint64_t seeds = test::runs(2000);
  for (bool sequence : {false, true}) {
    std::vector<double> seen(50, 0.0);
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      RowSampler sampler(m, seed);
      for (const auto& r : sequence ? sampler.next(10) : sampler.stratified(10)) seen[r.row] += 1;
    }
    const double expected = static_cast<double>(seeds) * 10 / 50;
    double chi = 0;
    for (double s : seen) chi += (s - expected) * (s - expected) / expected;
    EXPECT_LT(chi, 85.4) << sequence;
  }
}

TEST(RowSampler, SequencesCoverTheImageEvenlyAndNeverRepeat) {
  const auto m = matrix::low_rank_matrix({1024, 2, 1}, 1);
  RowSampler sampler(m, 5);
  std::set<matrix::Index> all;
  for (std::size_t step : {16u, 16u, 32u, 64u, 896u, 10u})
    for (const auto& r : sampler.next(step)) EXPECT_TRUE(all.insert(r.row).second);
  EXPECT_EQ(all.size(), 1024u);
  // The first 16 rows of a sequence are in 16 different sixteenths of the curve: on a square image, four in
  // each quadrant.
  RowSampler fresh(m, 6);
  const float half = 12;  // 1024 rows, two per pixel: 23 pixels wide
  int quadrant[2][2] = {{0, 0}, {0, 0}};
  for (const auto& r : fresh.next(16)) ++quadrant[m.pixel[r.row].x > half][m.pixel[r.row].y > half];
  for (auto& side : quadrant)
    for (int n : side) EXPECT_GE(n, 2);
}

TEST(RowSampler, DensityDrawsWhereItIsHigh) {
  const auto m = matrix::low_rank_matrix({4096, 2, 1}, 1);
  RowSampler sampler(m, 7);
  std::vector<float> density(4096, 0.0f);
  for (std::size_t i = 0; i < 4096; ++i)
    density[i] = m.pixel[i].x < 11 && m.pixel[i].y < 11;  // a sixteenth of the image
  std::size_t inside = 0;
  double squares = 0;
  const auto rows = sampler.next_by_density(200, density);
  for (const auto& r : rows) {
    inside += density[r.row] > 0;
    squares += static_cast<double>(r.weight) * static_cast<double>(r.weight);
  }
  EXPECT_GT(inside, rows.size() * 2 / 5);  // half by density and a sixteenth of the other half, less repeats
  // Σ weight² estimates the number of rows drawn; its deviation over strata is below that of independent
  // draws, whose weights² are at most 2: √200·2 bounds it generously, three times it is 85.
  EXPECT_NEAR(squares, static_cast<double>(rows.size()), 85);
}

}  // namespace
}  // namespace lumirank::methods
