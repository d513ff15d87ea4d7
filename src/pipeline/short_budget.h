// What a budget lacks that is short for a view, said in one way by all renders.
#pragma once

#include <string>

namespace lumirank::pipeline {

struct ShortBudget {
  double seconds = 0;    // the budget
  double building = 0;   // seconds that building the scene took
  bool is_over = false;  // by that alone
  double enough = 0;     // seconds that would do
};

// `lacks`: what is left out for it; may be empty.
std::string said(const ShortBudget& budget, const std::string& lacks);
// What is left out where light is rendered with so many times fewer pixels a side; empty for 1.
std::string said_of_smaller(int divisor);

}  // namespace lumirank::pipeline
