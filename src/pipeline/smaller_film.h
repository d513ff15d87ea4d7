// A film that is rendered smaller than it was asked for, because a budget is short, and enlarged.
#pragma once

#include "image/image.h"
#include "lumirank/lumirank.h"
#include "world/view.h"

namespace lumirank::pipeline {

using world::View;

// Whether the view is the whole film, which alone is enlarged again.
bool is_whole_film(const View& view);

// The same view, or window of it, on a film of a divisor-th of the width and height, at least one pixel.
View smaller(const View& view, int divisor);

// A film of so many times fewer pixels a side tells what the whole one will take: four, or more where that
// film would have more than 32,400 pixels.
int trial_divisor(const View& view);

// A film of half the width and height, enlarged by features of all pixels, is the better picture where fewer
// paths than this fit for each pixel: four times as many are left there, and the larger a picture is, the
// less of it is as small as a pixel. Fewer of those that have so many light paths beside them, which take as
// long as several.
double paths_worth_a_pixel(const View& view, double light_paths = 0);

// The picture at another size, linearly interpolated between centers of pixels.
Picture enlarged(const Picture& picture, int width, int height);
// The image as a picture of the size that the view asks for.
Picture sized_for(const image::Image& image, const View& view);

}  // namespace lumirank::pipeline
