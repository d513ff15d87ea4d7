// Advice where an error was asked for that more columns cannot reach.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "methods/method.h"

namespace lumirank::pipeline {

struct ErrorAsked {
  double target = 0;                // --error
  std::size_t lights = 0;           // asked for
  std::string option = "--lights";  // how to ask for more
  std::string decided_by = {};      // MethodInfo::error_parameters
};

// How many lights should bring the error under the target if half of it is left to sampling: the lights' part
// falls like 1/√N, and so does clamping, which darkens strips along edges as wide as the lights are apart.
// Two significant digits, rounded up.
double lights_for_error(const ErrorAsked& asked, double lights_part, double clamping_part);

// A warning beforehand where the method will not aim at the target: who decides instead. Else empty.
std::string error_not_aimed_at(const methods::MethodInfo& method, double target);

// A warning that names the parts and the remedy. Empty if the target was met, or if the error is not known.
// `numbers`: of the method's trace.
std::string error_advice(const ErrorAsked& asked, const std::map<std::string, double>& numbers);

// A warning where a method's time was too short for more than a coarse estimate of a part of the picture,
// with a budget that would do. `given`: the seconds that it got. `enough_for_plan`: the budget that would
// have lowered nothing else. `numbers`: of the method's trace (budget.coarse_share, budget.seconds_wanted).
std::string budget_advice(double budget, double given, double enough_for_plan,
                          const std::map<std::string, double>& numbers);

}  // namespace lumirank::pipeline
