// Which runs of a comparison may be compared: those of about the same cost or error.
#pragma once

#include <string>
#include <vector>

#include "pages/results.h"

namespace lumirank::study {

// For `equal` = "time", "rays" or "error": of every method, a line about the run nearest to the best run of
// the first one. Nothing for "" or without runs of the first method.
std::vector<std::string> runs_at_equal(const std::string& equal, const std::vector<std::string>& methods,
                                       const std::vector<pages::CompareRun>& runs);

}  // namespace lumirank::study
