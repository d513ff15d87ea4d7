// OpenEXR allocates tables by the sizes in a file's header before anyone can check them; so we check first.
#pragma once

#include <cstddef>
#include <string>

namespace lumirank::image {

// Throws InputError if the file begins as an EXR and the data window of one of its parts holds more than
// max_pixels, is empty, or would need a table of chunks longer than the file. Whatever else is wrong is left
// to the decoder.
void require_sane_exr_header(const std::string& filename, std::size_t max_pixels);

}  // namespace lumirank::image
