// Numbers as colors.
#pragma once

#include "image/image.h"

namespace lumirank::image {

// The color, linear, of t in [0, 1] (clamped; NaN is magenta): dark blue over teal to yellow. Perceptually
// uniform by construction: lightness in Oklab (Ottosson 2020) is linear in t, hue turns at a constant rate,
// chroma stays inside sRGB.
Rgb false_color(float t);

// A horizontal strip of the whole map, t = 0 at its left edge and 1 at its right.
Image color_bar(int width, int height);

}  // namespace lumirank::image
