// Thin bright lines, as of lamps in mirrors, that a denoiser makes brighter than anything it was given.
#pragma once

#include "image/image.h"

namespace lumirank::denoise {

// `denoised` with no pixel brighter than the brightest of the 25 noisy ones around it, where that is at least
// four times as bright as the picture's mean. Where all around is dark, what is brighter may be light that
// was found farther away. Throws InternalError for other sizes.
image::Image without_overshoot(const image::Image& noisy, image::Image denoised);

}  // namespace lumirank::denoise
