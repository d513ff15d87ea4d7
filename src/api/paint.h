// Pictures of what the scene computes, for formats that only have pictures.
#pragma once

#include <optional>

#include "scenedesc/writer/mitsuba_writer.h"
#include "world/notes.h"

namespace lumirank::api {

// A picture of the values of the texture in its texels' centers, as large as the largest picture that it is
// made of: OpenEXR in memory, of 16-bit floats. Nothing if it is made of no picture, of anything besides
// pictures and constants, or of pictures that are mapped, wrapped or filtered differently. Between the
// centers it is the filtered product where the texture is the product of what is filtered. InputError for a
// picture that cannot be read.
std::optional<scenedesc::BitmapTextureDesc> paint_texture(const scenedesc::SceneDesc& scene, int texture);

// All maps and constants that surround the scene, added up: OpenEXR of 32-bit floats, as the built world has
// them.
scenedesc::Painter::Environment paint_environment(const scenedesc::SceneDesc& scene, world::Notes& notes);

}  // namespace lumirank::api
