// Equal-area octahedral maps of the sphere, the environments of pbrt-v4.
#pragma once

#include "base/vec.h"
#include "image/image.h"

namespace lumirank::world {

// Clarberg, Fast equal-area mapping of the (hemi)sphere using SIMD (2008): the sphere, folded into an
// octahedron and onto the unit square; +z in its middle, -z at its corners.
Vec2f sphere_to_square(Vec3f direction);

// A square map resampled, with the same mean radiance of each channel, to latitudes and longitudes: row 0 at
// +z, column 0 at +x, columns growing towards +y; as high as the square and twice as wide.
image::Image to_latitude_longitude(const image::Image& square);

// Illuminance (of radiance as luminance: ∫ L cosθ dω) of a plane that faces +z under such a map.
double illuminance_of_pole(const image::Image& map);

}  // namespace lumirank::world
