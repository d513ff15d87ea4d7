// How a budget is divided, with made-up costs: no clock is asked.
#include "pipeline/time_plan.h"

#include <gtest/gtest.h>

#include "pipeline/timed_passes.h"

namespace lumirank::pipeline {
namespace {

// About what two cores measure in a room of 640 × 360.
TimeCosts ordinary_costs() {
  TimeCosts c;
  c.passed = 0.4;
  c.pixels = 640 * 360;
  c.receiver = c.film_sample = 5e-7;
  c.direct = 0;
  c.column = 2e-8;
  c.develop = 1e-7;
  c.light = 4e-6;
  return c;
}
TimeWishes budget_of(double seconds) {
  TimeWishes w;
  w.budget = seconds;
  return w;
}
double planned_seconds(const TimePlan& p, const TimeCosts& c) {
  const double samples = c.pixels * p.spp;
  return c.passed + samples * c.receiver + c.pixels * p.film_samples * c.film_sample +
         static_cast<double>(p.lights) * c.light + p.direct_seconds + p.rest_seconds + p.film_seconds;
}

TEST(TimePlan, AHugeBudgetLowersNothing) {
  const TimePlan p = plan_time(budget_of(1e6), ordinary_costs());
  EXPECT_GE(p.spp, 4);
  EXPECT_EQ(p.lights, 100000u);
  EXPECT_EQ(p.shortage, "");
  EXPECT_FALSE(p.build_alone);
}

// The method ends with what takes as long as some 3,000 of the pilot's columns: beyond that only more
// receivers use the time.
TEST(TimePlan, AbundantTimeGoesToReceivers) {
  TimeCosts c = ordinary_costs();
  c.pixels = 50000, c.column = 1e-8;  // 3,000 columns for one receiver per pixel take 1.5 s
  EXPECT_EQ(plan_time(budget_of(2), c).spp, 4);
  const TimePlan p = plan_time(budget_of(40), c);
  EXPECT_GT(p.spp, 4);
  const double to_the_end = 3000 * c.column * c.pixels * p.spp;
  EXPECT_GE(to_the_end, 0.85 * (kTimeAim * 40 - c.passed));
  TimeWishes by_hand = budget_of(40);
  by_hand.spp_given = true;
  EXPECT_EQ(plan_time(by_hand, c).spp, 4);
  c.pixels = 2e6;
  EXPECT_EQ(plan_time(budget_of(1e6), c).spp, 4) << "memory is not for the taking";
}

TEST(TimePlan, FilmSamplesAreGivenUpWhereTheyCostTooMuch) {
  TimeCosts c = ordinary_costs();
  c.pixels = 50000, c.passed = 0;
  const auto planned = [&](double seconds, bool given = false) {
    TimeWishes w = budget_of(seconds);
    w.film_samples = 16, w.film_samples_given = given;
    return plan_time(w, c).film_samples;
  };
  // 0.025 s for one of each pixel, twice: 16 of them are a fifth of 4 s.
  c.film_sample = 5e-7;
  EXPECT_EQ(planned(5), 16);
  EXPECT_EQ(planned(3), 8);
  EXPECT_EQ(planned(1.5), 4) << "for three receivers";
  EXPECT_EQ(planned(0.2), 0);
  EXPECT_EQ(planned(1.5, true), 16) << "asked for by hand";
  // Where time abounds there are more receivers than film samples.
  c.column = 1e-8;
  EXPECT_EQ(planned(1000), 0);
  EXPECT_EQ(planned(1000, true), 16);
}

TEST(TimePlan, EveryBudgetLeavesTheMethodItsPart) {
  for (const double seconds : {1.0, 3.0, 8.0, 20.0})
    for (const double direct : {0.0, 1e-7, 1e-6})
      for (const int rest : {0, 16, 64})
        for (const double light : {1e-6, 1e-4}) {
          TimeCosts c = ordinary_costs();
          c.direct = direct, c.light = light;
          TimeWishes w = budget_of(seconds);
          w.rest_paths = rest;
          w.film_samples = 16;
          const TimePlan p = plan_time(w, c);
          const double left = kTimeAim * seconds - c.passed;
          // The fewest lights are had whatever they cost.
          const double lights_over = std::max(0.0, static_cast<double>(p.lights) * c.light - 0.2 * left);
          if (p.spp > 1) {
            EXPECT_LE(planned_seconds(p, c) - lights_over, kTimeAim * seconds - 0.05 * left)
                << seconds << " " << direct << " " << rest;
          }
          EXPECT_GE(p.spp, 1);
          EXPECT_LE(p.spp, 4);
        }
}

TEST(TimePlan, VerySlowDirectLightCostsReceiversAndKeepsItsShare) {
  TimeCosts c = ordinary_costs();
  c.direct = 14.6 / (16 * 4 * c.pixels);  // 16 samples at 4 receivers per pixel take 14.6 s
  const TimePlan p = plan_time(budget_of(5), c);
  const double left = kTimeAim * 5 - c.passed;
  EXPECT_LT(p.spp, 4);
  EXPECT_LE(p.direct_seconds, 0.2 * left + 1e-9);
  EXPECT_NE(p.shortage.find("receivers per pixel"), std::string::npos) << p.shortage;
  EXPECT_GT(p.enough, 5);
  // With the time that it says would do, nothing is lowered, and nothing is said.
  const TimePlan enough = plan_time(budget_of(p.enough), c);
  EXPECT_GE(enough.spp, 4);
  EXPECT_EQ(enough.shortage, "") << p.enough;
}

TEST(TimePlan, DearLightsBecomeFewer) {
  TimeCosts c = ordinary_costs();
  c.light = 1e-4;  // 100,000 take 10 s
  const TimePlan p = plan_time(budget_of(5), c);
  EXPECT_LT(p.lights, 100000u);
  EXPECT_GE(p.lights, 2000u);
  EXPECT_LE(static_cast<double>(p.lights) * c.light, 0.2 * 5);
  EXPECT_NE(p.shortage.find("virtual lights"), std::string::npos) << p.shortage;
  EXPECT_EQ(plan_time(budget_of(p.enough), c).shortage, "");
}

TEST(TimePlan, WhatWasAskedForByHandIsKeptAndSaid) {
  TimeCosts c = ordinary_costs();
  c.light = 1e-4, c.column = 1e-6;
  TimeWishes w = budget_of(3);
  w.spp = 16, w.spp_given = true;
  w.lights = 200000, w.lights_given = true;
  const TimePlan p = plan_time(w, c);
  EXPECT_EQ(p.spp, 16);
  EXPECT_EQ(p.lights, 200000u);
  EXPECT_NE(p.shortage.find("--spp 16"), std::string::npos) << p.shortage;
  EXPECT_NE(p.shortage.find("--lights 200000"), std::string::npos) << p.shortage;
}

TEST(TimePlan, ATinyBudgetSaysThatBuildingAloneTookIt) {
  TimeCosts c = ordinary_costs();
  c.passed = 4;
  const TimePlan p = plan_time(budget_of(3), c);
  EXPECT_TRUE(p.build_alone);
  EXPECT_EQ(p.spp, 1);
  EXPECT_EQ(p.direct_seconds, 0);
  EXPECT_NE(p.shortage.find("building the scene took 4 s"), std::string::npos) << p.shortage;
  EXPECT_GT(p.enough, 4);
}

// A film of 2 megapixels in 2 s: a hundred columns for every pixel would take longer alone.
TEST(TimePlan, AFilmThatIsTooLargeIsRenderedSmaller) {
  TimeCosts c = ordinary_costs();
  c.pixels = 2e6;
  TimeWishes w = budget_of(2);
  w.may_be_smaller = true;
  const TimePlan p = plan_time(w, c);
  EXPECT_EQ(p.divisor, 2);
  EXPECT_GE(p.columns, 40);
  EXPECT_NE(p.shortage.find("1/2 of its width"), std::string::npos) << p.shortage;
  const TimePlan enough = plan_time(
      [&] {
        TimeWishes longer = w;
        longer.budget = p.enough;
        return longer;
      }(),
      c);
  EXPECT_EQ(enough.divisor, 1);
  EXPECT_EQ(enough.shortage, "") << p.enough;
  w.may_be_smaller = false;  // layers or a crop are wanted
  EXPECT_EQ(plan_time(w, c).divisor, 1);
  w.may_be_smaller = true, w.spp_given = true;
  EXPECT_EQ(plan_time(w, c).divisor, 1);
}

// One path for every pixel of what columns cannot carry is the least that there is.
TEST(TimePlan, PathsThatDoNotFitMakeTheFilmSmaller) {
  TimeCosts c = ordinary_costs();
  TimeWishes w = budget_of(4);
  w.may_be_smaller = true, w.rest_paths = 16;
  EXPECT_EQ(plan_time(w, c).divisor, 1);
  c.rest = 2e-5;  // 4.6 s
  EXPECT_EQ(plan_time(w, c).divisor, 2);
  c.rest = 1e-3;
  EXPECT_EQ(plan_time(w, c).divisor, 4) << "and no smaller";
}

TEST(TimePlan, WithoutColumnsNothingIsShort) {
  TimeCosts c = ordinary_costs();
  c.column = 0;
  TimeWishes w = budget_of(3);
  w.may_be_smaller = true;
  EXPECT_EQ(plan_time(w, c).divisor, 1);
}

TEST(TimePlan, AStageThatBeginsLateGetsLess) {
  EXPECT_EQ(stage_seconds(0.5, 10), 0.5);
  EXPECT_EQ(stage_seconds(0.5, 1), 0.25);
  EXPECT_EQ(stage_seconds(0.5, -1), 0);
}

// ------------------------------------------------------------ passes, by a clock that is turned by hand

struct HandClock {
  double now = 0;
  Clock clock() {
    return [this] { return now; };
  }
};

TEST(TimedPasses, FillTheirShareAndDoNotPassIt) {
  for (const double cost : {0.001, 0.03, 0.4})
    for (const double share : {0.5, 1.0, 7.0}) {
      HandClock hand;
      hand.now = 2;
      const auto done = run_passes({0, 1, 1 << 20, 2 + share, 0}, hand.clock(), [&](int n) {
        hand.now += cost * n;
        return true;
      });
      EXPECT_LE(hand.now, 2 + std::max(share, cost) + 1e-9) << cost << " " << share;
      EXPECT_GT(hand.now, 2 + share - cost - 1e-9) << "not one more would have fit";
      EXPECT_NEAR(done.pace, cost, 1e-9);
    }
}

TEST(TimedPasses, WhatMustBeDoneIsDoneWhenTimeIsUp) {
  HandClock hand;
  hand.now = 9;
  int units = 0;
  const auto pass = [&](int n) {
    hand.now += 5.0 * n;
    units += n;
    return true;
  };
  EXPECT_EQ(run_passes({0, 1, 16, 3, 0}, hand.clock(), pass).done, 1);
  EXPECT_EQ(units, 1);
  EXPECT_EQ(run_passes({1, 1, 16, 3, 5}, hand.clock(), pass).done, 1) << "and no more";
}

TEST(TimedPasses, AnInstantClockEndsAtTheMost) {
  HandClock hand;
  int passes = 0;
  const auto done = run_passes({0, 1, 100, 1, 0}, hand.clock(), [&](int) { return ++passes > 0; });
  EXPECT_EQ(done.done, 100);
  EXPECT_LE(passes, 9) << "they double";
}

TEST(TimedPasses, ACancelledPassDoesNotCount) {
  HandClock hand;
  const auto done = run_passes({0, 1, 100, 1, 0}, hand.clock(), [&](int n) { return n < 4; });
  EXPECT_TRUE(done.cancelled);
  EXPECT_EQ(done.done, 4);
}

}  // namespace
}  // namespace lumirank::pipeline
