// Portable float map: three floats per pixel after a three-line text header.
#pragma once

#include <cstddef>
#include <string>

#include "image/image.h"

namespace lumirank::image {

// "PF", little endian, bottom row first, as the format demands. Throws InputError if the file cannot be
// written whole.
void write_pfm(const std::string& filename, const Image& image);

// Color ("PF") and gray ("Pf"), either byte order; the values as stored (the header's scale only tells the
// byte order). Throws InputError: not a PFM file, sizes that are not positive or above max_pixels, fewer
// bytes than the header says.
Image read_pfm(const std::string& filename, std::size_t max_pixels);

}  // namespace lumirank::image
