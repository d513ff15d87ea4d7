#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "linalg/density_map.h"
#include "linalg/separation.h"

namespace lumirank::linalg {
namespace {

// A known low-rank matrix, of which a share of the entries is wrong.
struct Case {
  std::size_t rows, columns;
  std::vector<float> truth, d, e;
  std::vector<Entry> state;
};

// Gaussian factors, `wrong` of the entries off by ±(1 … 3) times the root mean square: the test problems of
// Shen, Wen and Zhang 2014 (section 4).
Case gaussian_case(std::size_t rows, std::size_t columns, std::size_t rank, float wrong) {
  Case c{rows, columns, std::vector<float>(rows * columns), {}, {}, {}};
  Rng rng(1, Stage::test, 100, rank);
  std::vector<float> a(rows * rank), b(columns * rank);
  for (float& x : a) x = static_cast<float>(rng.next_gaussian());
  for (float& x : b) x = static_cast<float>(rng.next_gaussian() / std::sqrt(static_cast<double>(rank)));
  for (std::size_t j = 0; j < columns; ++j)
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t k = 0; k < rank; ++k) c.truth[j * rows + i] += a[i * rank + k] * b[j * rank + k];
  c.d = c.truth;
  for (float& x : c.d)
    if (rng.next_float() < wrong) x += (rng.next_float() < 0.5f ? -1.0f : 1.0f) * (1 + 2 * rng.next_float());
  c.state.assign(c.d.size(), Entry::predicted_visible);
  return c;
}

// Half of the rows do not see a third of the columns; a share of what was not sampled is predicted wrongly.
Case shadow_case(float sampled, float wrong) {
  const std::size_t rows = 300, columns = 240;
  Case c{rows, columns, {}, {}, std::vector<float>(rows * columns), {}};
  Rng rng(2, Stage::test, 101);
  std::vector<float> a(rows), b(columns);
  for (float& x : a) x = 0.5f + rng.next_float();
  for (float& x : b) x = 0.5f + rng.next_float();
  for (std::size_t j = 0; j < columns; ++j)
    for (std::size_t i = 0; i < rows; ++i) {
      const float e = a[i] * b[j];
      const bool visible = !(i < rows / 2 && j < columns / 3);
      const bool exact = rng.next_float() < sampled;
      const bool said = exact ? visible : visible != (rng.next_float() < wrong);
      c.e[j * rows + i] = e;
      c.truth.push_back(visible ? e : 0);
      c.d.push_back(said ? e : 0);
      c.state.push_back(exact ? Entry::exact : said ? Entry::predicted_visible : Entry::predicted_hidden);
    }
  return c;
}

double relative(std::span<const float> a, std::span<const float> b) {
  double off = 0, whole = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double x = static_cast<double>(a[k]), y = static_cast<double>(b[k]);
    off += (x - y) * (x - y);
    whole += y * y;
  }
  return std::sqrt(off / whole);
}

SeparationSettings patient() {
  SeparationSettings s;
  s.constraint = false;
  s.iterations = 200;
  s.tolerance = 1e-5;
  s.min_progress = 0;
  return s;
}

// The paper of the solver recovers such problems to its tolerance, exactly but for that. With the support of
// Z found, XY differs from the truth by the residual alone, of norm tolerance·‖D‖; the corrupted tenth is
// inferred from the other entries of its row and column, so nothing is amplified by more than a small factor:
// 10 here. ‖D‖² = (1 + 0.1 · 13/3) ‖truth‖².
TEST(Separation, RecoversTheSolversOwnTestProblems) {
  for (const std::size_t rank : {1u, 3u, 8u}) {
    const Case c = gaussian_case(200, 150, rank, 0.1f);
    Separation s;
    s.run({c.rows, c.columns, c.d, c.state, {}}, patient());
    EXPECT_EQ(s.rank(), rank);
    EXPECT_LT(relative(s.low_rank(), c.truth), 10 * 1.2 * 1e-5 * 10) << rank;
    ASSERT_LE(s.iterations(), 200u);
    // D = XY + Z.
    std::vector<float> sum(c.d.size());
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = s.low_rank()[k] + s.sparse()[k];
    EXPECT_LT(relative(sum, c.d), 1e-3) << rank;
  }
}

TEST(Separation, TakesNothingFromAMatrixWithoutErrors) {
  const Case c = gaussian_case(120, 160, 4, 0);
  Separation s;
  s.run({c.rows, c.columns, c.d, c.state, {}}, patient());
  EXPECT_EQ(s.rank(), 4u);
  EXPECT_LT(relative(s.low_rank(), c.truth), 1e-4);
}

// Within the 20 iterations of the paper: the truth is of rank 2, a tenth or a fifth of the predictions is
// wrong, so D's error is about √(wrong); the separation must remove at least three quarters of it.
TEST(Separation, RemovesWrongPredictions) {
  for (const bool constraint : {false, true})
    for (const float wrong : {0.1f, 0.2f}) {
      const Case c = shadow_case(0.05f, wrong);
      SeparationSettings settings;
      settings.constraint = constraint;
      Separation s;
      s.run({c.rows, c.columns, c.d, c.state, c.e}, settings);
      EXPECT_LE(s.iterations(), 20u);
      EXPECT_LT(relative(s.low_rank(), c.truth), 0.25 * relative(c.d, c.truth)) << constraint << ' ' << wrong;
      for (std::size_t k = 0; k < c.d.size(); ++k)
        if (c.state[k] == Entry::exact) {
          ASSERT_EQ(s.sparse()[k], 0.0f);
        }
    }
}

// As printed, predictions mean nothing; a quarter of the entries of a matrix of rank 2 determine the rest.
TEST(Separation, ThePrintedFitRecoversFromExactEntriesAlone) {
  Case c = shadow_case(0.25f, 0.0f);
  for (std::size_t k = 0; k < c.d.size(); ++k)
    if (c.state[k] != Entry::exact) c.d[k] = 0;
  SeparationSettings settings = patient();
  settings.iterations = 400;
  settings.fit = SeparationSettings::Fit::exact_only;
  Separation s;
  s.run({c.rows, c.columns, c.d, c.state, c.e}, settings);
  EXPECT_GT(relative(c.d, c.truth), 0.8);  // √(1 − 0.25) of it is missing
  EXPECT_LT(relative(s.low_rank(), c.truth), 0.1);
}

TEST(Separation, EntriesWithoutMeaningDoNotMatter) {
  Case c = gaussian_case(150, 120, 2, 0);
  Rng rng(3, Stage::test, 102);
  for (std::size_t k = 0; k < c.d.size(); ++k)
    if (rng.next_float() < 0.3f) {
      c.d[k] = 0;
      c.state[k] = Entry::free;
    }
  SeparationSettings settings = patient();
  settings.max_rank = 2;
  Separation s;
  s.run({c.rows, c.columns, c.d, c.state, {}}, settings);
  EXPECT_LT(relative(s.low_rank(), c.truth), 1e-2);
}

TEST(Separation, WorkSpaceLeavesNoTrace) {
  const Case large = shadow_case(0.05f, 0.1f), small = gaussian_case(40, 30, 2, 0.1f);
  Separation fresh, used;
  fresh.run({small.rows, small.columns, small.d, small.state, {}}, patient());
  used.run({large.rows, large.columns, large.d, large.state, large.e}, {});
  used.run({small.rows, small.columns, small.d, small.state, {}}, patient());
  EXPECT_EQ(std::vector<float>(fresh.low_rank().begin(), fresh.low_rank().end()),
            std::vector<float>(used.low_rank().begin(), used.low_rank().end()));
  EXPECT_EQ(fresh.iterations(), used.iterations());
}

TEST(Separation, EmptyDarkAndTiny) {
  Separation s;
  s.run({0, 0, {}, {}, {}}, {});
  EXPECT_EQ(s.rank(), 0u);
  const std::vector<float> dark(12, 0.0f), one{3};
  const std::vector<Entry> state(12, Entry::predicted_hidden), exact{Entry::exact};
  s.run({4, 3, dark, state, dark}, {});
  EXPECT_EQ(std::vector<float>(s.low_rank().begin(), s.low_rank().end()), dark);
  s.run({1, 1, one, exact, one}, {});
  EXPECT_NEAR(s.low_rank()[0], 3, 0.05);
}

TEST(DensityMap, WeightsAddUpToOneAndFallWithDistance) {
  const std::size_t rows = 20, columns = 15;
  std::vector<std::uint8_t> z(rows * columns, 1);
  DensityMap map;
  map.build(z, rows, columns);
  for (const float v : map.density()) EXPECT_NEAR(v, 1, 1e-5);
  std::fill(z.begin(), z.end(), std::uint8_t{0});
  z[7 * rows + 9] = 1;
  map.build(z, rows, columns);
  double sum = 0;
  for (std::size_t j = 0; j < columns; ++j)
    for (std::size_t i = 0; i < rows; ++i) {
      const double v = static_cast<double>(map.density()[j * rows + i]);
      sum += v;
      const bool near = i + 3 >= 9 && i <= 12 && j + 3 >= 7 && j <= 10;
      EXPECT_EQ(v > 0, near) << i << ' ' << j;
    }
  EXPECT_NEAR(sum, 1, 1e-5);
  // exp(−1/(2·1.4²)) of the middle, one step to either side.
  const float middle = map.density()[7 * rows + 9];
  EXPECT_NEAR(map.density()[7 * rows + 10] / middle, std::exp(-0.5f / (1.4f * 1.4f)), 1e-5f);
  EXPECT_NEAR(map.density()[6 * rows + 9] / middle, std::exp(-0.5f / (1.4f * 1.4f)), 1e-5f);
}

}  // namespace
}  // namespace lumirank::linalg
