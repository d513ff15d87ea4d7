// Another filter for a picture whose pixels are means over themselves: a denoiser wants these, whose noise is
// not alike, but a scene may ask for a wider filter, and looks sharper than was meant without it.
#pragma once

#include "film/filter.h"
#include "image/image.h"

namespace lumirank::film {

// ∫ x² f(x) dx / ∫ f(x) dx, square pixels. Below 1/12, that of a pixel's own square, a filter sharpens.
double variance(const Filter& filter);

// The picture of a box filter one pixel wide, averaged with neighboring pixels until both together have the
// variance of `filter`; pixels beyond the borders are those at them. The picture itself where the filter is
// no wider than the box.
image::Image refiltered(image::Image of_box, const Filter& filter);

}  // namespace lumirank::film
