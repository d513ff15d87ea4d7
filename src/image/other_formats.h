// All formats that have no reader of their own here (TIFF, TGA, BMP, WebP, PSD, DDS, …): OpenImageIO reads
// them. It brings some two hundred shared libraries, which take longer to load than a small picture takes to
// render; so it is linked to a module that is loaded when such a file is met.
#pragma once

#include <string>

#include "image/pixel_sink.h"

namespace lumirank::image {

// What the module exports, by this name. `error` stays empty if the file could be read.
inline constexpr const char* kReadOtherImage = "lumirank_read_other_image";
using ReadOtherImage = void (*)(const std::string& filename, PixelSink& sink, std::string& error);

// Throws InputError if the module or the libraries it needs are not there, std::runtime_error if it cannot
// read the file.
void read_other_format(const std::string& filename, PixelSink& sink);

}  // namespace lumirank::image
