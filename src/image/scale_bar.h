// False-color pictures of a quantity, with a legend that says how much.
#pragma once

#include <string>

#include "image/image.h"

namespace lumirank::image {

// Both ends of a scale; the greater one shows as the brightest color.
struct Range {
  float low = 0, high = 1;
};
// From 0 to the first of 1, 2, 3, 5 times a power of ten that at most one pixel in 200 exceeds (of the first
// channel). 0 to 1 where nothing is above 0.
Range round_range(const Image& values);

// The first channel as false colors, and below it a color bar with five or six numbers and the unit. Taller
// than the picture by the legend's height; as wide. Linear RGB, for write_image without exposure or tone map.
// Letters known: digits, '.', and those of "lux", "k" and "M".
Image with_scale(const Image& values, Range range, const std::string& unit);

}  // namespace lumirank::image
