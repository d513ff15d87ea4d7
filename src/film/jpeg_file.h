// JPEG files, by libjpeg.
#pragma once

#include <string_view>

#include "film/pixel_sink.h"

namespace lumirank::film {

// Baseline and progressive; grey, colour, and the four inks of printers (which become colours). Profiles and
// the orientation in the file are ignored. Throws std::runtime_error for what is not right in the bytes.
void read_jpeg(std::string_view bytes, PixelSink& sink);

}  // namespace lumirank::film
