// Row-guided sampling: every receiver draws its own few columns, guided by rows near it that were read whole.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo row_guided_sampling_info();

}  // namespace lumirank::methods
