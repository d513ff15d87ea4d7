// Lightcuts (Walter, Fernandez, Arbree, Bala, Donikian, Greenberg 2005).
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo lightcuts_info();

}  // namespace lumirank::methods
