#include "methods/virtual_ray_lights/virtual_ray_lights.h"

#include "methods/common/few_lights.h"

namespace lumirank::methods {

MethodInfo virtual_ray_lights_info() {
  return few_lights_info(
      {"virtual-ray-lights",
       "Generates few points and, in media, rays of light, and renders all of them for whole eye rays.",
       "Novák, Nowrouzezahrai, Dachsbacher, Jarosz 2012, Virtual ray lights for rendering scenes with "
       "participating media",
       "",
       {.needs = {}, .combination = true, .segments = matrix::MethodContract::Segments::whole}},
      "Points and rays");
}

}  // namespace lumirank::methods
