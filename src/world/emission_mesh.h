// Meshes that shine by a texture. A light is chosen by its triangle's power, and a place on it evenly: where
// a picture has two triangles, as a screen or a sign does, most places would be in its dark. So such meshes
// are divided until a triangle has few texels.
#pragma once

#include "geometry/mesh.h"
#include "scatter/texture.h"

namespace lumirank::world {

// How many texels lie along the longest edge of a triangle; `texels`: TextureSet::texels().
float texels_along(const geometry::TriangleMesh& mesh, std::size_t triangle, Vec2f texels);

// The same surface with every triangle in n² equal ones, n such that there are at most `max_triangles`, or
// the mesh as it was: without uvs of its own, with so many triangles already, or where the parts are all
// about as bright. What triangles share stays shared, to the bit.
geometry::TriangleMesh divided_by_texture(geometry::TriangleMesh mesh, int texture,
                                          const scatter::TextureSet& textures, std::size_t max_triangles);

}  // namespace lumirank::world
