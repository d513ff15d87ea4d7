// Stochastic lightcuts (Yuksel 2019, 2020).
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo stochastic_lightcuts_info();

}  // namespace lumirank::methods
