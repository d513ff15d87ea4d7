// Pixels of which two halves of the samples agree by chance, so that their noise is taken for a detail.
#pragma once

#include <span>

#include "image/image.h"

namespace lumirank::denoise {

// The difference of halves (twice the noise of `noisy`), but where a pixel is three times as bright as
// `denoised`, and that may be noise by what its own samples say (three deviations of its luminance): there
// at least twice this deviation. Where light is found by few paths of very many, one in either half says
// that there is no noise. `deviation` empty: nothing is known. Throws InternalError for other sizes.
image::Image with_outliers(image::Image difference, const image::Image& noisy, const image::Image& denoised,
                           std::span<const float> deviation);

}  // namespace lumirank::denoise
