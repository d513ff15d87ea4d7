// The last guard: no picture with values that are no numbers leaves the program.
#pragma once

#include "image/image.h"

namespace lumirank::pipeline {

// InputError if a pixel is infinite or not a number: how many, the first of them, and the likely cause.
void check_pixels(const image::Image& image);

}  // namespace lumirank::pipeline
