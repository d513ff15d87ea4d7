#include "pipeline/error_advice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "methods/common/exact_rows.h"

namespace lumirank::pipeline {
namespace {

constexpr double kMaxLights = 1e7;  // more than this is no advice

std::string number(const char* format, double x) {
  char text[64];
  std::snprintf(text, sizeof text, format, x);
  return text;
}
std::string percent(double x) { return number("%.2g %%", 100 * x); }

}  // namespace

double lights_for_error(const ErrorAsked& asked, double lights_part, double clamping_part) {
  const auto error_at = [&](double x) {
    return std::hypot(0.5 * asked.target, lights_part * x) + clamping_part * x;
  };
  double lo = 0, hi = 1;  // 1/√(times as many)
  if (error_at(hi) > asked.target)
    for (int k = 0; k < 60; ++k) (error_at(0.5 * (lo + hi)) > asked.target ? hi : lo) = 0.5 * (lo + hi);
  else
    lo = 1;
  const double count = static_cast<double>(asked.lights) / (lo * lo);
  const double step = std::pow(10.0, std::floor(std::log10(std::max(count, 1.0))) - 1);
  return std::ceil(count / step * (1 - 1e-12)) * step;
}

std::string error_not_aimed_at(const methods::MethodInfo& method, double target) {
  if (target <= 0 || method.error_parameters.empty()) return {};
  return "--error (" + percent(target) + ") has no effect on " + method.name + "; set " +
         method.error_parameters + " (--set), or use row-column-sampling";
}

std::string error_advice(const ErrorAsked& asked, const std::map<std::string, double>& numbers) {
  const auto total = numbers.find("error.estimate");
  if (asked.target <= 0 || total == numbers.end() || total->second <= asked.target) return {};
  const double sampling = numbers.at("error.sampling"), lights = numbers.at("error.lights"),
               clamping = numbers.at("error.clamping");
  std::string text = "the error is estimated at " + percent(total->second) + ", above the " +
                     percent(asked.target) + " asked for: sampling " + percent(sampling) +
                     ", number of lights " + percent(lights) + ", clamping " + percent(clamping);
  if (std::hypot(methods::target_for_sampling(asked.target, lights, clamping), lights) + clamping <=
      asked.target * (1 + 1e-9))
    return text + (asked.decided_by.empty() ? "; give more time"
                                            : "; set other values of " + asked.decided_by + " (--set)");
  const double count = lights_for_error(asked, lights, clamping);
  text += "; more columns will not reduce it";
  if (count > kMaxLights)
    text += ", and it would take " + number("%.1e", count) + " lights; give a larger error";
  else
    text += "; try " + asked.option + (asked.option.back() == '=' ? "" : " ") + number("%.0f", count);
  if (clamping > 0.5 * asked.target) text += ", or a larger --clamp (0: none), for brighter spots";
  return text;
}

std::string budget_advice(double budget, double given, double enough_for_plan,
                          const std::map<std::string, double>& numbers) {
  const auto coarse = numbers.find("budget.coarse_share"), wanted = numbers.find("budget.seconds_wanted");
  if (coarse == numbers.end() || coarse->second < 0.005) return {};
  const std::string part = coarse->second < 0.995 ? "in " + percent(coarse->second) + " of" : "in all of";
  std::string text = part + " the picture the budget of " + number("%.3g s", budget) +
                     " left time for a coarse estimate only";
  if (wanted != numbers.end() && wanted->second > given)
    text += "; about " + number("%.2g s", std::max(budget + wanted->second - given, enough_for_plan)) +
            " would do";
  return text;
}

}  // namespace lumirank::pipeline
