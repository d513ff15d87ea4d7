#include "methods/instant_radiosity/instant_radiosity.h"

#include "methods/common/few_lights.h"

namespace lumirank::methods {

MethodInfo instant_radiosity_info() {
  return few_lights_info({"instant-radiosity", "Generates few virtual lights and renders all of them.",
                          "Keller 1997, Instant Radiosity", "", matrix::kCombination},
                         "Virtual lights");
}

}  // namespace lumirank::methods
