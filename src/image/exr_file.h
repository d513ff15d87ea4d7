// OpenEXR files, by the OpenEXR library.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>

#include "image/image_io.h"
#include "image/pixel_sink.h"

namespace lumirank::image {

// The first part's data window at its finest level: the channels R, G and B, or else the first three (or the
// only one) that are not alpha, layers in the order of their names. Throws std::exception for what is not
// right in the file.
void read_exr(const std::string& filename, PixelSink& sink);

// All layers, as `precision` says, packed losslessly. `out` has to be seekable. Throws std::exception.
void write_exr(std::ostream& out, const LayeredImage& image, Precision precision);

// Threads of OpenEXR's own for so many bytes of pixels or file, 0 if the caller's one does it as fast: as
// many as the arena had when the first large file was opened.
int exr_threads(std::size_t bytes);

}  // namespace lumirank::image
