// Slices for column completion: those that came with the rows, and slices by place for all other rows.
#pragma once

#include "methods/common/slices/slices.h"

namespace lumirank::methods {

// given: as RowFeatures::slice has them. k_means: as many, by the distances of places from the means of
// clusters (figure 6). places: by place and normal (make_slices). stretches: by number alone.
enum class RowPartition { given, places, stretches, k_means };

// No slice has more rows than `max_rows`, but for those that were given and for clusters.
Slices completion_slices(const matrix::RowFeatures& features, std::size_t rows, std::size_t max_rows,
                         RowPartition partition);

}  // namespace lumirank::methods
