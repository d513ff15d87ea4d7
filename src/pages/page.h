// The files of a comparison: results.json, results.csv and one page that opens from the disk without a
// network.
#pragma once

#include <string>

#include "lumirank/compare.h"

namespace lumirank::pages {

// Write results.json and results.csv into `folder`, whole or not at all; throw InputError if they cannot be
// written. Numbers read back as the same bits; those that are not finite are null in JSON and empty in CSV.
void write_results_json(const std::string& folder, const Comparison& results);
// One line per run (RFC 4180); the columns of settings and phases are the union over the runs.
void write_results_csv(const std::string& folder, const Comparison& results);

// Writes `folder`/index.html. The images that the results name lie, or will lie, beside it.
void write_comparison_page(const std::string& folder, const Comparison& results);

}  // namespace lumirank::pages
