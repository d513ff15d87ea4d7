// Choices of a run under a time budget, written down and repeated.
#include "methods/common/timed_choices.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"
#include "matrix/synthetic.h"
#include "methods/method_names.h"

namespace lumirank::methods {
namespace {

Estimate run_timed(const std::string& method, const matrix::LightingMatrix& m, double seconds, double target,
                   TimedChoices& choices) {
  RunOptions options;
  options.time_seconds = seconds;
  options.target_error = target;
  options.choices = &choices;
  return find_method(method).make({})->run(m, options);
}

class EveryTimedMethod : public testing::TestWithParam<std::string> {};

// The budget of the repetition is another, so any reading of the clock that was forgotten would show.
TEST_P(EveryTimedMethod, RepeatsTheSameBits) {
  const auto m = matrix::sparse_matrix({400, 2000, 1}, 0.2);
  for (const double seconds : {1e-6, 0.002, 0.02})
    for (const double target : {0.0, 0.01}) {
      TimedChoices made;
      const Estimate first = run_timed(GetParam(), m, seconds, target, made);
      EXPECT_FALSE(made.made().empty());
      for (const double other : {1e-6, 1e6}) {
        TimedChoices again(made.made());
        Estimate second;
        with_threads(2, [&] { second = run_timed(GetParam(), m, other, target, again); });
        again.expect_end();
        EXPECT_TRUE(first.sums == second.sums) << seconds << " s, target " << target;
        EXPECT_EQ(again.made(), made.made()) << "a repetition can be repeated";
      }
    }
}

INSTANTIATE_TEST_SUITE_P(All, EveryTimedMethod, testing::ValuesIn(test::method_names()), test::name_of_test);

TEST(TimedChoices, WithoutABudgetNoneAreMade) {
  const auto m = matrix::low_rank_matrix({500, 1000, 1}, 40);
  for (const MethodInfo& info : all_methods()) {
    TimedChoices none;
    run_timed(info.name, m, 0, 0.05, none);
    EXPECT_TRUE(none.made().empty()) << info.name;
  }
}

TEST(TimedChoices, ThoseOfAnotherMatrixAreRefused) {
  TimedChoices empty((TimedChoices::Lists()));
  EXPECT_THROW(empty.earlier("rows", 10), InputError);
  TimedChoices large({{"rows", {11}}});
  EXPECT_THROW(large.earlier("rows", 10), InputError);
  TimedChoices longer({{"rows", {3, 4}}});
  EXPECT_EQ(longer.earlier("rows", 10), 3);
  EXPECT_THROW(longer.expect_end(), InputError);
  TimedChoices other({{"receivers", {3}}});
  EXPECT_THROW(other.expect("receivers", 4), InputError);
}

}  // namespace
}  // namespace lumirank::methods
