// Radiance as a screen shows it, for metrics of what people see: one exposure for all pictures of a scene.
#pragma once

#include "image/image.h"

namespace lumirank::image {

// Screen's light for a unit of radiance, 0.245 over the median of all channels of `reference`, so that the
// scene's units do not matter. The median of the positive ones if that is not positive (a small object on
// black), and infinity if none is. No value may be NaN.
double exposure_for(const Image& reference);

// Linear sRGB in [0, 1]: each channel times `exposure`, x, becomes 1.25 x / (1 + x), cut off at 1 (from x = 4
// on) and at 0. Noise of single bright pixels weighs as little as it does on a screen.
Image on_screen(const Image& radiance, double exposure);

}  // namespace lumirank::image
