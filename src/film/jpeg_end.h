// JPEG decoders paint the missing part of a truncated file grey and call it a warning; we want an error.
#pragma once

#include <string>

namespace lumirank::film {

// Throws InputError if the file begins as a JPEG and its pixel data does not end in the end-of-image marker.
void require_jpeg_end(const std::string& filename);

}  // namespace lumirank::film
