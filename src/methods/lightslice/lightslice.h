// LightSlice (Ou and Pellacini 2011, "LightSlice: matrix slice sampling for the many-lights problem"): rows
// are cut into slices, and every slice gets clusters and columns of its own (slices/slice_lights.h, where our
// deviations stand).
//
// With color = scalar, zero-columns = sample and max-sum-share = 0 the estimate is unbiased: given the rows
// that were read, every column with any power has a known probability > 0 of being one of the slice's.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo lightslice_info();

}  // namespace lumirank::methods
