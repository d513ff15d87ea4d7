// Plan of a comparison's runs: methods × (time budgets, or swept parameters) × seeds.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lumirank/compare.h"

namespace lumirank::study {

struct PlannedRun {
  std::string method;
  std::string label;   // method and what was swept
  std::string series;  // the curve that the run belongs to
  std::map<std::string, std::string> method_settings;
  std::size_t lights = 0;
  int spp = 0;
  double time = 0;  // budget in seconds; 0: none
  std::uint64_t seed = 1;
};

// Throws InputError for an unknown method or parameter, or a sweep that no method uses.
std::vector<PlannedRun> plan_runs(const CompareSettings& settings);

}  // namespace lumirank::study
