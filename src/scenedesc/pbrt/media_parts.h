// What the kinds of pbrt's media share.
#pragma once

#include "scenedesc/pbrt/params.h"
#include "scenedesc/pbrt/reader.h"

namespace lumirank::scenedesc::pbrt {

// The integral of the CIE 1931 observer's ȳ, which is what pbrt's film makes of an illuminant. All lights are
// divided by it but the "Le" of rgbgrid (RGBGridMedium::Create) and what glows with its temperature.
inline constexpr float kUndivided = 106.856895f;

float not_negative(Params& p, const char* name, float fallback);
// A color or a spectrum, not a texture.
Rgb constant(Params& p, const char* name, Rgb fallback, Intent intent);

// "sigma_a" and "sigma_s" times "scale", or those of a "preset" and, without "g", its phase function.
void coefficients(Reader& reader, Params& p, MediumDesc& out);

// "p0" and "p1", whichever corners they are.
struct Box {
  Vec3d lo, hi;
  // From the unit cube, under the transform of the medium. InputError if that is singular.
  Transform to_world(const Params& p, const Transform& medium_to_world) const;
};
Box read_box(Params& p);

// "cloud": its density on a grid (cloud.cpp).
void add_cloud(Reader& reader, Params& p, const Transform& to_world, MediumDesc& out);
// "nanovdb" (sparse_media.cpp); false if its file is missing and it is left out.
bool add_sparse_grids(Reader& reader, Params& p, const Transform& to_world, MediumDesc& out);

}  // namespace lumirank::scenedesc::pbrt
