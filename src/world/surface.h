// Differential geometry of one triangle of a placed mesh.
#pragma once

#include "geometry/mesh.h"
#include "geometry/ray_scene.h"
#include "scatter/material.h"

namespace lumirank::world {

// Unit normal of a triangle in the mesh's frame on its outside: by the order of the corners, turned to the
// side of the vertex normals where the mesh has them (as Mitsuba does; one decision per triangle, so lights
// have one bright side). Zero for a degenerate triangle.
Vec3f outside_normal(const geometry::TriangleMesh& mesh, std::size_t triangle);

// Interpolated texture coordinates and color; without uv in the mesh the barycentric coordinates serve.
scatter::SurfaceUv interpolate_uv(const geometry::TriangleMesh& mesh, std::uint32_t triangle,
                                  Vec2f barycentric);

}  // namespace lumirank::world
