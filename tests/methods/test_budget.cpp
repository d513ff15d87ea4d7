// What every method does with a time that is far too short, short, and long. Time passes by the entry, so
// that nothing here depends on the machine.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "matrix/metered_matrix.h"
#include "matrix/synthetic.h"
#include "methods/common/coarse_picture.h"
#include "methods/common/column_pass.h"
#include "methods/common/timed_choices.h"
#include "methods/common/turns.h"
#include "methods/method_names.h"
#include "methods/parameters.h"

namespace lumirank::methods {
namespace {

constexpr double kSecondsOfEntry = 1e-6;

struct TimedRun {
  Estimate estimate;
  double seconds = 0;
};

double seconds_of(const matrix::MeteredMatrix& m) {
  return kSecondsOfEntry * static_cast<double>(m.total().entries);
}

class EveryBudget : public testing::TestWithParam<std::string> {
 protected:
  const MethodInfo& info() const { return find_method(GetParam()); }
  // Slices of 40 rows at most, and cuts of their own instead of blocks of the picture: many units.
  SettingsMap settings() const {
    for (const Parameter& p : info().parameters)
      if (p.key == "slice-rows")
        return {{"slice-rows", "40"}};
      else if (p.key == "reconstruction")
        return {{"reconstruction", "off"}};
    return {};
  }
  TimedRun run(const matrix::LightingMatrix& m, double seconds, TimedChoices* choices = nullptr) const {
    RunOptions options;
    options.time_seconds = seconds;
    options.choices = choices;
    const matrix::MeteredMatrix metered(m);
    const auto now = [&] { return seconds_of(metered); };
    options.clock = now;
    TimedRun run;
    const double begin = now();
    with_threads(1, [&] { run.estimate = info().make(settings())->run(metered, options); });
    run.seconds = now() - begin;
    return run;
  }
};

// All entries of the matrix take 1.2 s. At 1/1000 of that a method has a row's or a column's worth of
// entries.
TEST_P(EveryBudget, EveryLitRowHasAnEstimateHoweverShortTheTime) {
  const auto m = matrix::low_rank_matrix({1200, 1000, 1}, 5);
  const auto exact = m.exact_sums();
  for (const double seconds : {1e-9, 0.001, 0.01, 0.05, 0.2}) {
    const Estimate e = run(m, seconds).estimate;
    ASSERT_EQ(e.sums.size(), m.rows());
    EXPECT_FALSE(e.interrupted);
    for (std::size_t i = 0; i < m.rows(); ++i) {
      EXPECT_TRUE(is_finite(e.sums[i]));
      ASSERT_TRUE(is_black(exact[i]) || !is_black(e.sums[i])) << "row " << i << " at " << seconds << " s";
    }
    EXPECT_TRUE(e.trace.numbers.contains("budget.coarse_share")) << seconds;
  }
}

// One column for all rows takes 1.2 ms, and no method can show less: from two hundred columns' time on it is
// kept. A step that is begun before the end (98.5 %) is a stretch of rows or some columns.
TEST_P(EveryBudget, TheTimeIsKept) {
  const auto m = matrix::low_rank_matrix({1200, 1000, 1}, 5);
  for (const double seconds : {0.25, 0.5, 1.0}) {
    const TimedRun r = run(m, seconds);
    EXPECT_LT(r.seconds, 1.02 * seconds) << seconds;
    // Where a method ends early it has its whole quality.
    if (r.seconds < 0.85 * seconds) {
      EXPECT_FALSE(r.estimate.trace.numbers.contains("budget.seconds_wanted"))
          << r.seconds << " of " << seconds;
    }
  }
}

TEST_P(EveryBudget, LongTimesEnd) {
  const auto m = matrix::low_rank_matrix({300, 400, 1}, 5);
  const TimedRun r = run(m, 1e6);
  EXPECT_FALSE(r.estimate.trace.numbers.contains("budget.seconds_wanted"));
  EXPECT_LT(relative_l1_difference(r.estimate.sums, m.exact_sums()), 0.1);
}

// What is stated is the error of all rows that were read first, whatever became of their estimates: at all
// rows of a small matrix it is the true one.
TEST_P(EveryBudget, TheStatedErrorIsThatOfTheWholePicture) {
  const auto m = matrix::occluded_matrix({60, 1500, 3}, 8);
  for (const double seconds : {0.02, 0.05, 0.2, 2.0}) {
    const Estimate e = run(m, seconds).estimate;
    const auto stated = e.trace.numbers.find("error.estimate");
    if (stated == e.trace.numbers.end() || e.trace.numbers.at("error.rows") < 60) continue;
    EXPECT_NEAR(stated->second, relative_l1_difference(e.sums, m.exact_sums()), 1e-4) << seconds;
  }
}

TEST_P(EveryBudget, ErrorsFallWithTime) {
  const auto m = matrix::low_rank_matrix({1200, 1000, 1}, 5);
  const auto exact = m.exact_sums();
  const double early = relative_l1_difference(run(m, 0.002).estimate.sums, exact),
               late = relative_l1_difference(run(m, 1.0).estimate.sums, exact);
  EXPECT_LT(late, early);
  EXPECT_LT(late, 0.25);
}

TEST_P(EveryBudget, IsRepeatedByItsChoices) {
  const auto m = matrix::occluded_matrix({400, 500, 3}, 8);
  for (const double seconds : {0.003, 0.03}) {
    TimedChoices made;
    const Estimate first = run(m, seconds, &made).estimate;
    TimedChoices again(made.made());
    const Estimate second = run(m, 10 * seconds, &again).estimate;
    again.expect_end();
    EXPECT_TRUE(first.sums == second.sums) << seconds;
  }
}

// An error that cannot be had is not pursued for ever: ten times what the exact sums cost is enough for any.
TEST_P(EveryBudget, AnUnreachableErrorEnds) {
  const auto m = matrix::occluded_matrix({400, 300, 3}, 8);
  RunOptions options;
  options.target_error = 1e-9;
  const matrix::MeteredMatrix metered(m);
  const Estimate e = info().make(settings())->run(metered, options);
  EXPECT_LT(static_cast<double>(metered.total().entries), 10.0 * 400 * 300);
  EXPECT_TRUE(e.trace.numbers.contains("error.estimate"));
}

TEST_P(EveryBudget, EveryIntegerHasAHighestValue) {
  for (const Parameter& p : info().parameters) {
    if (p.type != "integer") continue;
    const std::size_t dots = p.range.find(" … ");
    ASSERT_NE(dots, std::string::npos) << p.key;
    const std::string max_value = p.range.substr(dots + std::string(" … ").size());
    EXPECT_NE(info().make({{p.key, max_value}}), nullptr) << p.key;
    EXPECT_LE(std::stoull(max_value), 10'000'000u) << p.key;
    try {
      info().make({{p.key, std::to_string(std::stoull(max_value) + 1)}});
      ADD_FAILURE() << p.key;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(max_value), std::string::npos) << e.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryBudget, testing::ValuesIn(test::method_names()), test::name_of_test);

struct Covered {
  std::vector<Rgb> sums;
  CoarsePicture picture;
  double seconds;
};
Covered coarse(const matrix::LightingMatrix& m, double seconds, std::uint64_t seed = 1) {
  RunOptions options;
  options.time_seconds = seconds;
  options.seed = seed;
  const matrix::MeteredMatrix metered(m);
  options.clock = [&] { return seconds_of(metered); };
  const RunClock clock(options);
  Covered c{std::vector<Rgb>(m.rows()), {}, 0};
  with_threads(1, [&] { c.picture = make_coarse_picture(metered, options, clock, c.sums); });
  c.seconds = seconds_of(metered);
  return c;
}

// Four fifths of the entries are 0: a row that a few columns leave dark has light nonetheless.
TEST(CoarsePicture, LightsRowsThatItsColumnsDoNotReach) {
  const auto m = matrix::sparse_matrix({600, 400, 1}, 0.2);
  const auto exact = m.exact_sums();
  for (const double seconds : {1e-9, 0.01, 0.1, 10.0}) {
    const Covered c = coarse(m, seconds);
    for (std::size_t i = 0; i < m.rows(); ++i) EXPECT_TRUE(is_black(exact[i]) || !is_black(c.sums[i])) << i;
  }
}

// Columns drawn in proportion to power p: the sum of n draws of a_j / p_j is unbiased. Mean of 60 pictures
// against the exact light of all rows, at five standard errors: a false alarm in a million.
TEST(CoarsePicture, IsUnbiased) {
  const auto m = matrix::low_rank_matrix({256, 300, 1}, 4);
  const auto light = [](std::span<const Rgb> sums) {
    double s = 0;
    for (const Rgb v : sums) s += static_cast<double>(luminance(v));
    return s;
  };
  const double exact = light(m.exact_sums());
  double sum = 0, squares = 0;
  const int count = 60;
  for (int k = 0; k < count; ++k) {
    const double r = light(coarse(m, 0.03, static_cast<std::uint64_t>(k)).sums) / exact - 1;
    sum += r, squares += r * r;
  }
  const double mean = sum / count, deviation = std::sqrt((squares / count - mean * mean) / count);
  EXPECT_LT(std::abs(mean), 5 * deviation);
  EXPECT_LT(deviation, 0.05);  // the test has teeth
}

// A twentieth of the time, and a fiftieth for rows; up to a fifth for the first sixteen columns of 2 ms; or
// one column each.
TEST(CoarsePicture, TakesATwentiethOfTheTime) {
  const auto m = matrix::low_rank_matrix({2000, 500, 1}, 4);
  for (const double seconds : {0.04, 0.2, 1.0, 3.0}) {
    const Covered c = coarse(m, seconds);
    EXPECT_TRUE(c.picture.all_rows_read);
    const double tolerance = seconds < 0.7 ? 0.25 : 0.07;
    EXPECT_LE(c.seconds, tolerance * seconds);
    EXPECT_GE(c.picture.columns, seconds < 0.1 ? 3u : 15u);
  }
  EXPECT_EQ(coarse(m, 1e-9).picture.columns, 1u);
  EXPECT_FALSE(coarse(m, 1e-9).picture.all_rows_read);
}

// A turn is shared out among slices: of 600 pixels, one or two of the usual size would be too few.
TEST(SliceCuts, HasSlicesEnoughForTurns) {
  const auto m = matrix::low_rank_matrix({1200, 1000, 1}, 5);
  const auto slices = [&](double seconds, SettingsMap settings) {
    RunOptions options;
    options.time_seconds = seconds;
    const matrix::MeteredMatrix metered(m);
    options.clock = [&] { return seconds_of(metered); };
    return find_method("slice-cuts").make(settings)->run(metered, options).trace.numbers.at("slices");
  };
  EXPECT_LE(slices(0, {}), 2);
  EXPECT_GE(slices(0.5, {}), 4);
  EXPECT_LE(slices(0.5, {{"slice-rows", "900"}}), 2) << "set by hand";
}

TEST(Turn, ScalesNumbers) {
  EXPECT_EQ(Turn{}.scaled(500), 500u);
  EXPECT_EQ((Turn{0.25, 0}.scaled(500)), 125u);
  EXPECT_EQ((Turn{1.0 / 64, 0}.scaled(10)), 1u);
}

}  // namespace
}  // namespace lumirank::methods
