// Settings of row-column sampling (Hašan, Pellacini, Bala 2007).
#pragma once

#include <cstddef>

#include "linalg/clustering.h"
#include "methods/parameters.h"

namespace lumirank::methods {

enum class ColourMode { averaged, scalar };
enum class ZeroColumns { sample, ignore };

struct RowColumnSettings {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::size_t projection = 50;
  linalg::ClusteringAlgorithm clustering = linalg::ClusteringAlgorithm::combined;
  ColourMode colour = ColourMode::averaged;
  ZeroColumns zero_columns = ZeroColumns::sample;
  double zero_share = 0.02;
  double power_share = 0.3;
  double most_shown = 0.5;
};

const Fields<RowColumnSettings>& row_column_fields();

}  // namespace lumirank::methods
