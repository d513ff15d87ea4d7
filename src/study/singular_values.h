// The singular values of a small part of a lighting matrix (Hašan et al. 2007, Figure 3).
#pragma once

#include <cstdint>
#include <vector>

#include "matrix/lighting_matrix.h"

namespace lumirank::study {

// Of the norms of the entries of 1,200 rows and 1,000 columns, evenly drawn; descending.
std::vector<double> singular_values_of(const matrix::LightingMatrix& matrix, std::uint64_t seed);

}  // namespace lumirank::study
