// The sum of all columns: the method brute-force, and what others do where no selection of columns pays.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

// Sum of all columns, in an order that makes every prefix a fair sample of them, so that it can be shown
// while it grows. With a time budget it may end early; the scaled part is then returned, and the trace says
// how much was done.
Estimate brute_force(const matrix::LightingMatrix& matrix, const RunOptions& options);
// The same, and its error by some rows.
Estimate brute_force_with_error(const matrix::LightingMatrix& matrix, const RunOptions& options);

}  // namespace lumirank::methods
