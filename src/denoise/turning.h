// Pictures turned by quarter turns.
#pragma once

#include "image/image.h"

namespace lumirank::denoise {

// By so many quarter turns clockwise, which may be none, or negative: those go back.
image::Image turned(const image::Image& image, int quarters);

}  // namespace lumirank::denoise
