// A picture that was rendered with fewer pixels than it is shown with gets its edges and textures back from
// features of all pixels, which cost little beside light.
#pragma once

#include "image/image.h"

namespace lumirank::denoise {

// Of fewer or as many pixels: the means over the areas of the new ones.
image::Image reduced(const image::Image& image, int width, int height);

// `small` at the size of the features, which are as Denoiser::denoise() takes them: interpolated linearly,
// and added to that, by a linear model of the light in albedo and normal, what the features of a pixel differ
// from interpolated ones. The model is fitted around each pixel of the small picture to it and to reduced
// features by weighted least squares, with a little ridge, so that features that do not vary say nothing
// (guided upsampling by a first-order model, as in Bitterli et al. 2016, "Nonlinearly Weighted First-order
// Regression for Denoising Monte Carlo Renderings"). What is added leads to no less than four fifths and no
// more than five fourths of what the pixels around have, first of their light and then, where they have an
// albedo, of their light over it; where all four have one, the color of the light over albedo is theirs at
// that brightness. `small` must not have emission that is seen straight, which features do not know, and no
// noise. Throws InternalError for features of different sizes, or smaller than the picture.
image::Image enlarged(const image::Image& small, const image::Image& albedo, const image::Image& normal);

}  // namespace lumirank::denoise
