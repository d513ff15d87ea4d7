// Differential geometry of one triangle of a placed mesh.
#pragma once

#include "geometry/mesh.h"
#include "geometry/ray_scene.h"
#include "scatter/material.h"
#include "world/world.h"

namespace lumirank::world {

// Unit normal of a triangle in the mesh's frame on its outside: by the order of the corners, turned to the
// side of the vertex normals where the mesh has them (as Mitsuba does; one decision per triangle, so lights
// have one bright side). Zero for a degenerate triangle.
Vec3f outside_normal(const geometry::TriangleMesh& mesh, std::size_t triangle);

// Of a triangle in the world; of a segment of a fiber its length times its width, which is what light from
// the side meets.
double primitive_area(const World& world, std::uint32_t placement, std::uint32_t primitive);

// Interpolated texture coordinates and color; without uv in the mesh the barycentric coordinates serve.
scatter::SurfaceUv interpolate_uv(const geometry::TriangleMesh& mesh, std::uint32_t triangle,
                                  Vec2f barycentric);

}  // namespace lumirank::world
