// What a denoiser took away that was no noise comes back: details that it mistook for noise, and the bias
// that would stay however long a render goes on.
#pragma once

#include "image/image.h"

namespace lumirank::denoise {

struct Shrunk {
  image::Image picture;
  double kept = 0;  // the mean over pixels of the noisy picture's weight, [0, 1]
};

// The noisy picture shrunk towards the denoised one, as James and Stein (1961) shrink a mean whose noise is
// known towards a guess: around every pixel denoised + w (noisy − denoised), with
//   w = max(0, 1 − 3 noise / distance),
// noise the mean square of the noisy picture's noise and distance that of noisy − denoised, both relative to
// the brightness and over a Gaussian window of two pixels' deviation; for noise, an eighth of that over
// eight pixels' if it is more: where light is rarely found most small windows are dark and show no noise at
// all. For distance, twice that over 0.7 pixels' if it is less: a glint that the denoiser took would give
// back the noise of six pixels around it. Where noise explains the distance, w is 0; where it explains none
// of it, 1. The factor 3 (1 for the least expected error, were the noise known) makes up for noise that is
// told by two halves only. `difference`: of two independent halves, twice the noise of `noisy`. All of one
// size.
Shrunk shrink(const image::Image& noisy, const image::Image& denoised, const image::Image& difference);

}  // namespace lumirank::denoise
