#include "pipeline/time_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "pipeline/short_budget.h"

namespace lumirank::pipeline {
namespace {

// Shares of what is left after building. The method gets what the others leave, about half: its sums are the
// picture. Receivers and lights are a means to it: beyond a fifth each, fewer of them cost the picture less
// than the columns that their time buys. Traced light is noise next to the method's error where its share is
// a fifth too, and it gets what is left over at the end besides.
constexpr double kReceiverShare = 0.2, kLightShare = 0.2, kDirectShare = 0.2, kRestShare = 0.2,
                 kFilmShare = 0.15, kMethodShare = 0.4;
// Film samples are traced twice, to see which lack receivers and for the picture, and once more for each
// layer. They get no more than this part. As few as there are receivers make no better edges than these do.
constexpr double kFilmSamplesShare = 0.2;
// Fewer receivers per pixel are better than sums over fewer columns than this (a third of what slice-cuts has
// without a budget; with less, whole shadows are missing and slices show) ...
constexpr double kMinColumns = 150;
// ... or than direct light of fewer samples, whose noise four receivers of one sample have as well.
constexpr double kMinDirect = 4;
// slice-cuts has nothing left to gain beyond some 8,000 to 12,000 entries of a receiver, and would end before
// its time; they take about as long as 1,000 to 3,000 columns take the pilot. Where more than this many of
// the pilot's columns fit, more receivers per pixel serve the picture (cleaner edges) and use the time; no
// more than the film shows, nor than memory should be spent on (240 bytes for each of them).
constexpr double kManyColumns = 1000, kMaxSamples = 8e6;
constexpr int kMaxReceivers = 64;
// A film of half the width and height, enlarged, is better than sums over fewer columns than these for each
// of its pixels, of which a method has time for a third to a half (those that it chooses are lit, which the
// pilot's seldom are, and rows come first): kitchen, living-room and dining-room at 1280 × 720 in 3 s were
// flat or black, or with 27 columns of 79 half as bright again. And it is better than a budget that is not
// kept because single samples of every pixel take longer (paths: the pilot's few take about twice as long as
// those of a whole film). A quarter is the end, and shows: it takes more to be worth it.
constexpr double kFewColumns = 100, kFewColumnsOfHalf = 40, kMaxOfShare = 1.5, kMaxOfPathShare = 3;
constexpr int kMaxDivisor = 4;
constexpr double kMinPixels = 4096;  // fewer save no time worth having
// With fewer lights one sees each of them.
constexpr std::size_t kMinLights = 2000;

// Two significant digits, rounded up.
double planned_round(double seconds) {
  if (!(seconds > 0)) return 0;
  const double step = std::pow(10.0, std::floor(std::log10(seconds)) - 1);
  return std::ceil(seconds / step * (1 - 1e-12)) * step;
}

std::string planned_number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

// Seconds after building that so many receivers per pixel ask for.
double wanted_for_receivers(const TimeCosts& costs, int spp, int layers) {
  const double samples = costs.pixels * spp;
  return samples *
         std::max({costs.receiver / kReceiverShare, costs.develop * (1 + layers) / kFilmShare,
                   kMinDirect * costs.direct / kDirectShare, kMinColumns * costs.column / kMethodShare});
}

std::string shortage_text(const TimeWishes& wishes, const TimeCosts& costs, const TimePlan& plan,
                          double left) {
  std::string lacks;
  const auto add = [&](const std::string& text) { lacks += (lacks.empty() ? "" : ", ") + text; };
  if (plan.divisor > 1) add(said_of_smaller(plan.divisor));
  if (plan.spp < wishes.spp)
    add(std::to_string(plan.spp) + " instead of " + std::to_string(wishes.spp) + " receivers per pixel");
  else if (wishes.spp_given && wanted_for_receivers(costs, wishes.spp, wishes.layers) > left)
    add("--spp " + std::to_string(wishes.spp) + " takes more than its part");
  if (plan.lights < wishes.lights / 2)  // as many again are hardly seen
    add(std::to_string(plan.lights) + " instead of " + std::to_string(wishes.lights) + " virtual lights");
  else if (wishes.lights_given && static_cast<double>(wishes.lights) * costs.light > kLightShare * left)
    add("--lights " + std::to_string(wishes.lights) + " take more than their part");
  const double samples = costs.pixels * plan.spp;
  if (costs.direct > 0 && plan.direct_seconds < kMinDirect * samples * costs.direct * (1 - 1e-9))
    add("fewer than " + planned_number(kMinDirect) + " samples of traced direct light");
  if (lacks.empty() && !plan.build_alone) return {};
  return said({wishes.budget, costs.passed, plan.build_alone, plan.enough}, lacks);
}

TimePlan plan_of_size(const TimeWishes& wishes, const TimeCosts& costs) {
  TimePlan plan;
  const double left = std::max(0.0, kTimeAim * wishes.budget - costs.passed);
  plan.build_alone = !(left > 0);
  plan.spp = wishes.spp;
  if (!wishes.spp_given)
    while (plan.spp > 1 && wanted_for_receivers(costs, plan.spp, wishes.layers) > left) --plan.spp;
  const auto more_fit = [&](int spp) {
    const double samples = costs.pixels * spp;
    return samples <= kMaxSamples && wanted_for_receivers(costs, spp, wishes.layers) <= left &&
           kManyColumns * costs.column * samples <= left;
  };
  if (!wishes.spp_given)
    while (plan.spp >= wishes.spp && plan.spp < kMaxReceivers && more_fit(plan.spp + 1)) ++plan.spp;
  plan.film_samples = wishes.film_samples;
  const auto film_sample_seconds = [&](int times) {
    return costs.pixels * plan.film_samples * costs.film_sample * times;
  };
  if (!wishes.film_samples_given) {
    while (plan.film_samples > plan.spp && film_sample_seconds(2 + wishes.layers) > kFilmSamplesShare * left)
      plan.film_samples /= 2;
    if (plan.film_samples <= plan.spp) plan.film_samples = 0;
  }
  plan.lights = wishes.lights;
  if (!wishes.lights_given && static_cast<double>(wishes.lights) * costs.light > kLightShare * left) {
    const double fitting = kLightShare * left / costs.light;
    plan.lights = std::min(wishes.lights, std::max(kMinLights, static_cast<std::size_t>(fitting)));
  }
  const double samples = costs.pixels * plan.spp;
  // Their passes end earlier where they have as many samples as were wished for.
  plan.direct_seconds = costs.direct > 0 ? kDirectShare * left : 0;
  plan.rest_seconds = wishes.rest_paths > 0 ? kRestShare * left : 0;
  plan.film_seconds = samples * costs.develop * (1 + wishes.layers) + film_sample_seconds(1 + wishes.layers);
  const double others = samples * costs.receiver + film_sample_seconds(1) +
                        static_cast<double>(plan.lights) * costs.light + plan.direct_seconds +
                        plan.rest_seconds + plan.film_seconds;
  const double column = costs.column * samples;
  plan.columns = column > 0 ? std::max(0.0, left - others) / column : std::numeric_limits<double>::infinity();
  return plan;
}

// Whether every pixel can have what it needs least.
bool plan_holds(const TimePlan& plan, const TimeWishes& wishes, const TimeCosts& costs, double left) {
  return plan.columns >= (plan.divisor == 1 ? kFewColumns : kFewColumnsOfHalf) &&
         costs.pixels * costs.receiver <= kMaxOfShare * kReceiverShare * left &&
         costs.pixels * costs.direct <= kMaxOfShare * kDirectShare * left &&
         (wishes.rest_paths == 0 || costs.pixels * costs.rest <= kMaxOfPathShare * kRestShare * left);
}

}  // namespace

double stage_seconds(double planned, double left) {
  constexpr double kMaxOfRest = 0.25;
  return std::clamp(planned, 0.0, std::max(0.0, kMaxOfRest * left));
}

TimePlan plan_time(const TimeWishes& wishes, const TimeCosts& costs) {
  const double left = std::max(0.0, kTimeAim * wishes.budget - costs.passed);
  TimePlan plan = plan_of_size(wishes, costs);
  TimeCosts fewer = costs;
  if (wishes.may_be_smaller && !wishes.spp_given)
    while (plan.divisor < kMaxDivisor && !plan_holds(plan, wishes, fewer, left)) {
      const int divisor = 2 * plan.divisor;
      if (costs.pixels < kMinPixels * divisor * divisor) break;
      fewer.pixels = costs.pixels / (divisor * divisor);
      plan = plan_of_size(wishes, fewer);
      plan.divisor = divisor;
    }
  const double paths = wishes.rest_paths > 0 ? costs.pixels * costs.rest / (kMaxOfPathShare * kRestShare) : 0;
  plan.enough = planned_round(
      (costs.passed + std::max({wanted_for_receivers(costs, wishes.spp, wishes.layers), paths,
                                static_cast<double>(wishes.lights) * costs.light / kLightShare})) /
      kTimeAim);
  plan.shortage = shortage_text(wishes, fewer, plan, left);
  return plan;
}

}  // namespace lumirank::pipeline
