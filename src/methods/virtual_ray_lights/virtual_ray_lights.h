// Virtual ray lights (Novák, Nowrouzezahrai, Dachsbacher, Jarosz, "Virtual ray lights for rendering scenes
// with participating media", ACM Transactions on Graphics 31(4), 2012): all of them, each with every eye ray
// as a whole. The baseline of what samples them; without media it is brute-force.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo virtual_ray_lights_info();

}  // namespace lumirank::methods
