// The one table of render settings: the command line, JSON and `--help` are made from it, in its order.
#pragma once

#include <vector>

#include "settings/rows.h"

namespace lumirank::settings {

const std::vector<Row>& table();

// Its groups, each of which adds its rows to the end.
void add_light_rows(std::vector<Row>& t);   // virtual lights
void add_view_rows(std::vector<Row>& t);    // size, samples, depth
void add_run_rows(std::vector<Row>& t);     // seeds, threads, targets
void add_traced_rows(std::vector<Row>& t);  // what is traced beside the matrix
void add_output_rows(std::vector<Row>& t);  // camera, crop, layers

}  // namespace lumirank::settings
