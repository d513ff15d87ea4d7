#include "pipeline/short_budget.h"

#include <cstdio>

namespace lumirank::pipeline {
namespace {

std::string in_seconds(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g s", x);
  return text;
}

}  // namespace

std::string said(const ShortBudget& budget, const std::string& lacks) {
  std::string text = budget.is_over
                         ? "building the scene took " + in_seconds(budget.building) + ", and the budget of " +
                               in_seconds(budget.seconds) + " is over"
                         : "the budget of " + in_seconds(budget.seconds) + " is short for this view";
  if (!lacks.empty()) text += ": " + lacks;
  return text + "; about " + in_seconds(budget.enough) + " would do";
}

std::string said_of_smaller(int divisor) {
  return divisor > 1 ? "rendered with 1/" + std::to_string(divisor) + " of its width and height, and enlarged"
                     : "";
}

}  // namespace lumirank::pipeline
