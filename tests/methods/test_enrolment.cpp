// What every method must do, by the list.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/method_names.h"
#include "methods/parameters.h"

namespace lumirank::methods {
namespace {

class EveryMethod : public testing::TestWithParam<std::string> {
 protected:
  const MethodInfo& info() const { return find_method(GetParam()); }
};

TEST_P(EveryMethod, SettingsRoundTripThroughJson) {
  const SettingsMap defaults = effective_settings(info(), {});
  const auto back = nlohmann::json::parse(nlohmann::json(defaults).dump()).get<SettingsMap>();
  EXPECT_EQ(back, defaults);
  EXPECT_EQ(effective_settings(info(), back), defaults);
  EXPECT_NE(info().make(back), nullptr);
  EXPECT_EQ(defaults.size(), info().parameters.size());
  for (const Parameter& p : info().parameters) {
    EXPECT_FALSE(p.help.empty()) << p.key;
    EXPECT_FALSE(p.range.empty()) << p.key;
    EXPECT_TRUE(p.type == "integer" || p.type == "number" || p.type == "choice") << p.key;
  }
  EXPECT_FALSE(info().summary.empty());
}

// A room with shadows, where every step of every method has something to do: places, normals, two receivers
// per pixel, lamps of several colors, some of which no sampled row sees.
const matrix::DenseMatrix& busy_room() {
  static const auto m = [] {
    auto made = matrix::occluded_matrix({600, 400, 3}, 8);
    made.group.resize(made.columns());
    for (std::size_t j = 0; j < made.columns(); ++j) made.group[j] = static_cast<std::uint16_t>(j % 3);
    return made;
  }();
  return m;
}

std::vector<std::string> choices_of(const Parameter& p) {
  std::vector<std::string> choices;
  std::stringstream range(p.range);
  for (std::string choice; std::getline(range, choice, '|');) choices.push_back(choice);
  return choices;
}

// Every choice gives a picture of the room, and one of a parameter's choices another picture than its
// default, there or of a matrix that is mostly zero: a choice that nothing reads would not.
TEST_P(EveryMethod, EveryChoiceRunsAndOneMakesADifference) {
  const auto sparse = matrix::sparse_matrix({600, 400, 1}, 0.02);
  const auto exact = busy_room().exact_sums();
  // Fewer columns than there are, so that there is something to choose, and few rows, so that some are
  // unknown.
  SettingsMap few;
  for (const Parameter& p : info().parameters) {
    if (p.key == "columns" || p.key == "initial-columns") few[p.key] = "100";
    if (p.key == "rows") few[p.key] = "20";
  }
  const auto sums_with = [&](const matrix::DenseMatrix& m, const Parameter& p, const std::string& choice) {
    SettingsMap settings = few;
    settings[p.key] = choice;
    return info().make(settings)->run(m, {}).sums;
  };
  for (const Parameter& p : info().parameters) {
    if (p.type != "choice") continue;
    const auto usual = sums_with(busy_room(), p, p.default_text),
               usual_sparse = sums_with(sparse, p, p.default_text);
    bool differs = false;
    for (const std::string& choice : choices_of(p)) {
      const auto sums = sums_with(busy_room(), p, choice);
      EXPECT_LT(relative_l1_difference(sums, exact), 0.35) << p.key << '=' << choice;
      differs = differs || sums != usual || sums_with(sparse, p, choice) != usual_sparse;
      // Or another matrix is made for it.
      if (info().segments_wanted)
        differs = differs || info().segments_wanted({{p.key, choice}}) != info().segments_wanted({});
    }
    EXPECT_TRUE(differs) << p.key;
  }
}

TEST_P(EveryMethod, UnknownKeysListTheValidOnes) {
  try {
    info().make({{"no-such-key", "1"}});
    FAIL() << "accepted";
  } catch (const InputError& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("no-such-key"), std::string::npos);
    for (const Parameter& p : info().parameters) EXPECT_NE(text.find(p.key), std::string::npos) << text;
  }
}

TEST_P(EveryMethod, WrongValuesAreRefused) {
  for (const Parameter& p : info().parameters)
    for (const char* wrong : {"", "many", "-1", "1e400", "3 "}) {
      try {
        info().make({{p.key, wrong}});
        ADD_FAILURE() << p.key << " took '" << wrong << "'";
      } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find(p.key), std::string::npos);
      }
    }
}

// In slices of 40 pixels, where a method has slices, so that there are more of them than threads; also where
// it aims at an error. Nothing else is known of the rows of the sparse matrix than their number.
TEST_P(EveryMethod, SameBitsForAnyNumberOfThreads) {
  const auto sparse = matrix::sparse_matrix({600, 900, 1}, 0.3);
  SettingsMap settings;
  for (const Parameter& p : info().parameters)
    if (p.key == "slice-rows") settings[p.key] = "40";
  const auto method = info().make(settings);
  for (const matrix::DenseMatrix* m : {&sparse, &busy_room()})
    for (const double target : {0.0, 0.05}) {
      RunOptions options;
      options.seed = 5;
      options.target_error = target;
      Estimate first;
      for (const int threads : {1, 2, 3, 8})
        with_threads(threads, [&] {
          const Estimate e = method->run(*m, options);
          if (threads == 1) first = e;
          EXPECT_EQ(e.sums, first.sums) << threads << " threads, target " << target;
          ASSERT_EQ(e.combination.size(), first.combination.size());
          for (std::size_t k = 0; k < e.combination.size(); ++k) {
            EXPECT_EQ(e.combination[k].column, first.combination[k].column);
            EXPECT_EQ(e.combination[k].scale, first.combination[k].scale);
          }
        });
    }
}

TEST_P(EveryMethod, ShowsCompleteEstimatesAndReports) {
  const auto m = matrix::low_rank_matrix({300, 700, 1}, 5);
  RunOptions options;
  std::size_t shown = 0;
  std::vector<Rgb> last;
  options.on_estimate = [&](std::span<const Rgb> sums) {
    ASSERT_EQ(sums.size(), m.rows());
    for (Rgb v : sums) ASSERT_TRUE(is_finite(v));
    ++shown;
    last.assign(sums.begin(), sums.end());
  };
  double progress = 0;
  options.sinks.progress = [&](const char*, double fraction) { progress = fraction; };
  const Estimate e = info().make({})->run(m, options);
  EXPECT_GT(shown, 0u);
  EXPECT_EQ(last, e.sums);
  EXPECT_EQ(progress, 1.0);
  EXPECT_FALSE(e.interrupted);
  for (const char* key : {"seconds.columns", "rows", "columns", "sampling_rate"})
    EXPECT_TRUE(e.trace.numbers.contains(key)) << key;
  // Watching changes nothing.
  EXPECT_EQ(info().make({})->run(m, {}).sums, e.sums);
}

TEST_P(EveryMethod, CancelledRunsReturnWhatTheyHave) {
  const auto m = matrix::low_rank_matrix({200, 4000, 1}, 6);
  for (std::size_t after : {0u, 1u, 3u}) {
    std::atomic<bool> cancel{after == 0};
    std::size_t shown = 0;
    RunOptions options;
    options.target_error = 1e-3;
    options.sinks.cancel = &cancel;
    options.on_estimate = [&](std::span<const Rgb>) { cancel = ++shown >= after; };
    const Estimate e = info().make({})->run(m, options);
    ASSERT_EQ(e.sums.size(), m.rows());
    for (Rgb v : e.sums) EXPECT_TRUE(is_finite(v));
    if (after == 0) {
      EXPECT_TRUE(e.interrupted);
    }
    // Having shown a picture, the method returns a picture: on this matrix 32 columns give far less than 100
    // % error.
    if (after > 0) {
      EXPECT_LT(relative_difference(e.sums, m.exact_sums()), 1.0);
    }
  }
}

// A target steers the method, or the method says what does instead. Methods that sum all columns of theirs
// have no error to steer.
TEST_P(EveryMethod, AimsAtAnErrorOrSaysWhatDecidesIt) {
  const auto m = matrix::occluded_matrix({1200, 900, 3}, 8);
  const auto has = [&](const std::string& key) {
    return std::any_of(info().parameters.begin(), info().parameters.end(),
                       [&](const Parameter& p) { return p.key == key; });
  };
  // A search on a few slices wants many.
  const auto method = info().make(has("slice-rows") ? SettingsMap{{"slice-rows", "40"}} : SettingsMap{});
  const auto with_target = [&](double target) {
    RunOptions options;
    options.target_error = target;
    return method->run(m, options).sums;
  };
  const auto coarse = with_target(0.2), fine = with_target(0.012);
  if (info().error_parameters.empty()) {
    const double error = relative_l1_difference(fine, m.exact_sums());
    EXPECT_TRUE(error < 900 * 0x1p-24 || error < relative_l1_difference(coarse, m.exact_sums())) << error;
    return;
  }
  EXPECT_EQ(coarse, fine);
  std::stringstream named(info().error_parameters);
  for (std::string word; named >> word;) EXPECT_TRUE(word == "or" || has(word)) << word;
}

TEST_P(EveryMethod, CopesWithTinyAndDarkMatrices) {
  for (std::size_t n : {1u, 2u, 50u, 200u}) {
    const matrix::DenseMatrix dark(3, n, std::vector<Rgb>(3 * n));
    const Estimate e = info().make({})->run(dark, {});
    EXPECT_EQ(e.sums, std::vector<Rgb>(3, Rgb(0)));
    const auto m = matrix::clustered_matrix({1, n, 1}, 1);
    EXPECT_EQ(info().make({})->run(m, {}).sums.size(), 1u);
  }
  const matrix::DenseMatrix no_columns(4, 0, {});
  EXPECT_EQ(info().make({})->run(no_columns, {}).sums, std::vector<Rgb>(4, Rgb(0)));
  const matrix::DenseMatrix no_rows(0, 300, {});
  EXPECT_TRUE(info().make({})->run(no_rows, {}).sums.empty());
}

INSTANTIATE_TEST_SUITE_P(All, EveryMethod, testing::ValuesIn(test::method_names()), test::name_of_test);

TEST(Methods, UnknownNamesListTheValidOnes) {
  try {
    find_method("no-such-method");
    FAIL() << "accepted";
  } catch (const InputError& e) {
    for (const std::string& name : test::method_names())
      EXPECT_NE(std::string(e.what()).find(name), std::string::npos);
  }
}

TEST(Methods, InstantRadiosityWantsItsLights) {
  EXPECT_EQ(find_method("instant-radiosity").lights_wanted({{"lights", "123"}}), 123u);
  EXPECT_EQ(find_method("brute-force").lights_wanted({}), 0u);
}

}  // namespace
}  // namespace lumirank::methods
