// Instant radiosity (Keller 1997), the baseline IR of 2007, section 5: few lights are generated and all are
// rendered.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo instant_radiosity_info();

}  // namespace lumirank::methods
