// Pictures of surfaces that cover a part of each pixel only.
#pragma once

#include "image/image.h"

namespace lumirank::denoise {

// `picture` over `cover`, the part of each pixel that is covered (gray, [0, 1]): a thin bar before a window
// gets the light that a wall of it would have. Pixels of which less than half is covered get, the more the
// less, the light around them, from as far as there is any, by pulling and pushing over a pyramid (Gortler,
// Grzeszczuk, Szeliski, Cohen 1996, "The Lumigraph", section 3.4); black if nothing is covered. Even light
// is even whatever covers it. Throws InternalError for other sizes.
image::Image unpremultiplied(const image::Image& picture, const image::Image& cover);

// The inverse, where at least half is covered.
void premultiply(image::Image& picture, const image::Image& cover);

}  // namespace lumirank::denoise
