// Some decoders are too kind to truncated files: libjpeg paints the missing part gray. So the skeleton of
// JPEG and PNG files is walked before they are decoded.
#pragma once

#include <string_view>

namespace lumirank::image {

// Whether a file that begins as a JPEG or PNG goes on to the end marker of its format; true of any other.
bool has_file_end(std::string_view bytes);

}  // namespace lumirank::image
