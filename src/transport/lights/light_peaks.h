// Peaks of surface lights that are not lambertian: how bright they are where they are brightest.
#pragma once

#include <vector>

#include "base/rgb.h"
#include "transport/lights/virtual_lights.h"

namespace lumirank::transport {

// At least f_y towards any receiver, for light from `incoming`, and at least f_y times the cosine with the
// geometric normal (of a fiber: the sine).
struct LightPeak {
  Rgb max_f, max_f_cos;
  bool one_sided;  // nothing comes out behind the geometric normal
};
// By index into lights.closures.
std::vector<LightPeak> light_peaks(const VirtualLights& lights);

}  // namespace lumirank::transport
