// The error that a clustering will have, before any column is computed: at a few rows of every frame that are
// read whole and that no clustering knows. Ours.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "matrix/lighting_tensor.h"
#include "methods/tensor_clustering/cluster_columns.h"
#include "methods/tensor_clustering/cluster_reader.h"
#include "methods/tensor_clustering/row_mapping.h"

namespace lumirank::methods {

class TestRows {
 public:
  explicit TestRows(const matrix::LightingTensor& tensor) : tensor_(tensor), frames_(tensor.frames()) {}

  // Reads rows of a frame whole. Adds to `spent`.
  void read(std::size_t frame, std::vector<matrix::Index> rows, matrix::Cost& spent);

  // ‖estimate − truth‖ / ‖truth‖ over all frames, if clusters were carried as `mappings` say and nothing were
  // shaded afresh. Entries that are read are added to `spent`.
  double error(std::span<const ClusterColumn> clusters, const FrameMappings& mappings,
               const ClusterPeaks& peaks, matrix::Cost& spent) const;

 private:
  struct Frame {
    std::vector<matrix::Index> rows;
    std::vector<Rgb> truth;
  };
  const matrix::LightingTensor& tensor_;
  std::vector<Frame> frames_;
};

}  // namespace lumirank::methods
