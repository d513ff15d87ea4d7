// Textures that are computed from pictures, as one picture: for formats that only have pictures.
#pragma once

#include <optional>

#include "scenedesc/scene_desc.h"

namespace lumirank::rendering {

// A picture of the values of the texture in its texels' centres, as large as the largest picture that it is
// made of: OpenEXR in memory, of 16-bit floats. Nothing if it is made of no picture, of anything besides
// pictures and constants, or of pictures that are mapped, wrapped or filtered differently. Between the
// centres it is the filtered product where the texture is the product of what is filtered. InputError for a
// picture that cannot be read.
std::optional<scenedesc::BitmapTextureDesc> paint_texture(const scenedesc::SceneDesc& scene, int texture);

}  // namespace lumirank::rendering
