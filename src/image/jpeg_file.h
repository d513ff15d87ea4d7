// JPEG files, by libjpeg.
#pragma once

#include <string_view>

#include "image/pixel_sink.h"

namespace lumirank::image {

// Baseline and progressive; gray, color, and the four inks of printers (which become colors). Profiles and
// the orientation in the file are ignored. Throws std::runtime_error for what is not right in the bytes.
void read_jpeg(std::string_view bytes, PixelSink& sink);

}  // namespace lumirank::image
