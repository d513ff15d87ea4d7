// OpenEXR files, by the OpenEXR library.
#pragma once

#include <ostream>
#include <string>

#include "film/image_io.h"
#include "film/pixel_sink.h"

namespace lumirank::film {

// The first part's data window at its finest level: the channels R, G and B, or else the first three (or the
// only one) that are not alpha, layers in the order of their names. Throws std::exception for what is not
// right in the file.
void read_exr(const std::string& filename, PixelSink& sink);

// All layers, as `precision` says, packed losslessly. `out` has to be seekable. Throws std::exception.
void write_exr(std::ostream& out, const LayeredImage& image, Precision precision);

// Threads that OpenEXR may use: those of the arena in which the first file was opened.
int exr_threads();

}  // namespace lumirank::film
