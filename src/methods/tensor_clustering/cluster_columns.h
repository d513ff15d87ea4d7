// What a cluster of light-frame pairs is rendered by: the column of its representative, and what that is
// multiplied with in each of the cluster's frames (Hašan et al. 2008, section 4.5).
#pragma once

#include <cstdint>
#include <vector>

#include "linalg/rectangle_clustering.h"
#include "linalg/reduced_tensor.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

struct ClusterColumn {
  matrix::Index column = 0;
  std::uint32_t frame = 0;  // in which it is computed
  const linalg::RectangleClustering::Rectangle* of = nullptr;
  std::vector<Rgb> scale;  // in each of the rectangle's frames
};

// Of the largest norm, scaled per channel so that norms add up to those of the cluster's lights.
ClusterColumn column_of(const linalg::ReducedTensor& reduced,
                        const linalg::RectangleClustering::Rectangle& rectangle);

// The cluster in one of its frames when it is computed in that very frame (ours): by the representative's
// light, if it still is one of the brighter there, else by the brightest. Where nothing moves it is what is
// carried there.
matrix::ScaledColumn column_in_frame(const linalg::ReducedTensor& reduced, const ClusterColumn& of,
                                     std::uint32_t frame);

}  // namespace lumirank::methods
