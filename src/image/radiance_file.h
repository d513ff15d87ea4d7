// Radiance pictures (.hdr, .rgbe, .pic): three mantissas of eight bits with one exponent.
#pragma once

#include <string_view>

#include "image/pixel_sink.h"

namespace lumirank::image {

// Flat, in runs of either kind, and in any of the eight orders of rows and columns. Exposure and primaries in
// the header are ignored. Throws std::runtime_error for what is not right in the bytes.
void read_radiance(std::string_view bytes, PixelSink& sink);

}  // namespace lumirank::image
