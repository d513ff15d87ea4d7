// Errors of an image against a reference. Formulas in docs/command-line.md.
#pragma once

#include "image/image.h"
#include "lumirank/info.h"

namespace lumirank::image {

// Throws InputError if sizes differ or either image has NaN or infinite pixels (the message says how many).
PictureError compare(const Image& image, const Image& reference);

// |I-R| relative to the reference's mean, in false color (dark blue 0 … yellow `full` and more).
Image false_color_error(const Image& image, const Image& reference, float full = 0.5f);

}  // namespace lumirank::image
