// Matrix row-column sampling (Hašan, Pellacini, Bala 2007, "Matrix row-column sampling for the many-light
// problem").
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo row_column_info();

}  // namespace lumirank::methods
