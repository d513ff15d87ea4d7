// What a few rows of a frame were found to lack, given to the rows between them (ours): light that was
// carried from another frame is mostly off by what changes slowly over a surface, so to know it here and
// there is to know it everywhere.
#pragma once

#include <span>
#include <vector>

#include "base/rgb.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

struct FoundChanges {
  std::vector<matrix::Index> rows;  // each once
  std::vector<Rgb> change;          // of the light of each
};

// For every row that is not `known`, the mean of the changes around it, by nearness on the film (within some
// pixels) and on the surface (places in its plane, like normals), each as it would be at the row's own
// reflectance; nothing where there are none. One value for each row. Deterministic on any number of threads.
std::vector<Rgb> spread_changes(const matrix::RowFeatures& features, const FoundChanges& found,
                                const std::vector<bool>& known);

}  // namespace lumirank::methods
