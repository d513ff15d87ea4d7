// What lightslice and adaptive-lightslice do with the columns of a slice: they are rendered.
#pragma once

#include "methods/common/slices/slice_pass.h"

namespace lumirank::methods {

Estimate render_slices(const matrix::LightingMatrix& matrix, const RunOptions& options,
                       const SliceLightSettings& settings);

}  // namespace lumirank::methods
