// Costs of a picture's cuts, for the report of every method that makes one cut per receiver or pixel.
#pragma once

#include <algorithm>
#include <map>
#include <string>

#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

// Whole numbers, so that their sums do not depend on the order of the threads.
struct CutCosts {
  double cuts = 0, nodes = 0, max_nodes = 0;  // nodes: or pairs of nodes
  double bounds = 0, entries = 0;

  void add(const CutCosts& o) {
    cuts += o.cuts, nodes += o.nodes, max_nodes = std::max(max_nodes, o.max_nodes);
    bounds += o.bounds, entries += o.entries;
  }
  // `nodes_key`: what the mean size of a cut is called.
  void write(const matrix::LightingMatrix& matrix, const std::string& nodes_key,
             std::map<std::string, double>& numbers) const {
    const auto per = [](double what, double of) { return of > 0 ? what / of : 0.0; };
    const auto rows = static_cast<double>(matrix.rows()), columns = static_cast<double>(matrix.columns());
    numbers["rows"] = 0;
    numbers["columns"] = per(entries, rows);
    numbers["columns_max"] = max_nodes;
    numbers["cuts"] = cuts;
    numbers[nodes_key] = per(nodes, cuts);
    numbers["bounds"] = per(bounds, rows);
    numbers["sampling_rate"] = columns > 0 ? per(entries, rows * columns) : 1.0;
  }
};

}  // namespace lumirank::methods
