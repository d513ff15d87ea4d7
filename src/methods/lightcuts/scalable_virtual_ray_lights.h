// Scalable virtual ray lights (Vibert, Gruson, Stokholm, Mortensen, Jarosz, Hachisuka, Nowrouzezahrai 2019).
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo scalable_virtual_ray_lights_info();

}  // namespace lumirank::methods
