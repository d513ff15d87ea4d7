// Single pixels that a path or two in very many made bright: among little noise a denoiser takes them for
// details.
#pragma once

#include <span>

#include "image/image.h"

namespace lumirank::denoise {

// `noisy` with every firefly as bright as the pixels around it. A firefly is half as bright again as the
// brightest but one of the 24 around it, where these are alike (that one at most 1.6 times their mean); and
// what it is brighter by is less than two and a half deviations of itself: found by so few samples that
// nobody knows whether it is there. `deviation`: of each pixel's luminance, as its own samples say. What it
// loses becomes a faint glow of its surroundings, a twentieth of what is there at most: one alone says
// little, but many of them are light. Where much is noisy nothing is done. Throws InternalError for other
// sizes.
image::Image without_fireflies(const image::Image& noisy, std::span<const float> deviation);

}  // namespace lumirank::denoise
