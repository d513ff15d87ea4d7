// Brute force: all columns. The baseline whose result the others estimate (2007, section 5, "reference").
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo brute_force_info();

}  // namespace lumirank::methods
