// The last guard: no picture with values that are no numbers leaves the program.
#pragma once

#include "film/image.h"

namespace lumirank::rendering {

// InputError if a pixel is infinite or not a number: how many, the first of them, and the likely cause.
void check_pixels(const film::Image& image);

}  // namespace lumirank::rendering
