// PNG files, by libpng.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "image/pixel_sink.h"

namespace lumirank::image {

// Of any depth and kind: 1 to 16 bits, gray, palette or color, with alpha or one transparent color. Gamma
// and profiles in the file are ignored. Throws std::runtime_error for what is not right in the bytes.
void read_png(std::string_view bytes, PixelSink& sink);

// A file of 8 bits per color, marked as sRGB; three bytes a pixel.
std::string encode_png(int width, int height, const std::vector<unsigned char>& rgb);

}  // namespace lumirank::image
