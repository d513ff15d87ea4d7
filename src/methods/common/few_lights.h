// Methods that generate few lights and render all of them: their only parameter is how many.
#pragma once

#include <string>

#include "methods/parameters.h"

namespace lumirank::methods {

// `what`: the lights, in the parameter's help.
MethodInfo few_lights_info(const MethodText& text, const std::string& what);

}  // namespace lumirank::methods
