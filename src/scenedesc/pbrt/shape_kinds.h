// The shapes of pbrt, and what an area light does to them. Internal to this folder.
#pragma once

#include <optional>

#include "scenedesc/pbrt/reader.h"

namespace lumirank::scenedesc::pbrt {

// `to_world` may get a further step, so that a built-in shape is the one that is meant. Empty if the shape is
// left out, with a warning. Throws InputError.
std::optional<decltype(ShapeDesc::kind)> make_shape(Reader& reader, Params& p, const std::string& type,
                                                    Transform& to_world);

// Meshes that files hold in lists.
std::optional<decltype(ShapeDesc::kind)> triangle_mesh(Reader& reader, Params& p);
std::optional<decltype(ShapeDesc::kind)> bilinear_mesh(Reader& reader, Params& p);
std::optional<decltype(ShapeDesc::kind)> loop_surface(Reader& reader, Params& p);
std::optional<decltype(ShapeDesc::kind)> held_mesh(Params& p, MeshData mesh);
std::optional<decltype(ShapeDesc::kind)> curve(Reader& reader, Params& p);

// Puts the light on the shape. Empty, or the back of a lamp that shines to both sides: a copy that faces the
// other way, a hair's breadth behind.
std::optional<ShapeDesc> shine(Reader& reader, Params& p, ShapeDesc& shape, const AreaLight& light);

}  // namespace lumirank::scenedesc::pbrt
