// Point lights that throw a picture → prepared emitters.
#pragma once

#include "emitters/emitter.h"
#include "scatter/material.h"
#include "scatter/texture.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::world {

// `light` in the world's units; picture: its own, of the finished set. InputError for what makes no sense.
emitters::ProfileEmitter make_projection_light(const scenedesc::ProjectionLightDesc& light,
                                               const SourceLocation& where,
                                               const scatter::ColorInput& picture,
                                               const scatter::TextureSet& textures);

}  // namespace lumirank::world
