// Multidimensional lightcuts (Walter, Arbree, Bala, Greenberg 2006).
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo multidimensional_lightcuts_info();

}  // namespace lumirank::methods
