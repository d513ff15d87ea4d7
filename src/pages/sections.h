// The parts of the compare page, each one HTML element, or nothing where there is nothing to say.
#pragma once

#include <string>

#include "lumirank/compare.h"
#include "pages/summary.h"

namespace lumirank::pages {

// What was compared, against what, and how good that is.
std::string header_section(const Comparison& results, const ComparisonSummary& summary);
// Error against time and against rays.
std::string error_section(const Comparison& results, const ComparisonSummary& summary);
// Any two images side by side.
std::string image_section(const Comparison& results, const ComparisonSummary& summary);
// Every group of runs, and their seconds per phase.
std::string table_section(const ComparisonSummary& summary);
std::string phase_section(const ComparisonSummary& summary);
// Hašan, Pellacini, Bala 2007, Figure 3.
std::string singular_value_section(const Comparison& results);

}  // namespace lumirank::pages
