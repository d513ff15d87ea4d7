// FLIP: how different two pictures look to somebody who alternates between them.
#pragma once

#include "image/image.h"

namespace lumirank::image {

// 0.7 m from a screen that has 3840 pixels on 0.7 m: 3840·π/180, the default of the paper's own programs.
inline constexpr double kFlipPixelsPerDegree = 67.0206;

// Mean over all pixels of LDR-FLIP (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020,
// "FLIP: A Difference Evaluator for Alternating Images"): 0 for equal pictures, at most 1. Both are of one
// size and hold what a screen shows, linear sRGB in [0, 1] (image/on_screen.h makes it of radiance); outside
// their borders they go on as at the border. `pixels_per_degree` of the eye's angle is at least 1. Throws
// InputError if the sizes differ or there are no pixels.
double flip_error(const Image& image, const Image& reference,
                  double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace lumirank::image
