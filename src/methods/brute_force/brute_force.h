// Brute force: all columns. The baseline whose result the others estimate (2007, section 5, "reference").
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo brute_force_info();

// Sum of all columns, in an order that makes every prefix a fair sample of them, so that it can be shown
// while it grows. With a time budget it may end early; the scaled part is then returned, and the trace says
// how much was done.
Estimate sum_all_columns(const matrix::LightingMatrix& matrix, const RunOptions& options);
// The same, and its error by some rows.
Estimate sum_all_columns_and_look(const matrix::LightingMatrix& matrix, const RunOptions& options);

}  // namespace lumirank::methods
