// Settings of row-column sampling (Hašan, Pellacini, Bala 2007).
#pragma once

#include <cstddef>

#include "linalg/clustering.h"
#include "methods/common/cluster_settings.h"
#include "methods/common/reduced_matrix.h"
#include "methods/parameters.h"

namespace lumirank::methods {

struct RowColumnSettings : ClusterSettings {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::size_t projection = 50;
  RowWeights row_weights = RowWeights::eye;
  linalg::ClusteringAlgorithm clustering = linalg::ClusteringAlgorithm::combined;
};

const Fields<RowColumnSettings>& row_column_fields();

}  // namespace lumirank::methods
