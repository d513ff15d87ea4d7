// Perlin's improved noise (Perlin, Improving Noise, 2002), with the directions that pbrt gives it.
#pragma once

#include "base/vec.h"

namespace lumirank::scenedesc::pbrt {

// About between -1 and 1; 0 at whole coordinates.
float perlin_noise(Vec3f p);
// Its differences over 0.01 along each axis, as a slope: pbrt's DNoise.
Vec3f perlin_slope(Vec3f p);

}  // namespace lumirank::scenedesc::pbrt
