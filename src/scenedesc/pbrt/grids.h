// Meshes of shapes that are given as a map from (u, v) in [0, 1]² to points.
#pragma once

#include <functional>

#include "scenedesc/schema/mesh.h"

namespace lumirank::scenedesc::pbrt {

struct GridPoint {
  Vec3f position, normal;
  Vec2f uv;
};

// Appends columns × rows cells of two triangles each. Corners run counter-clockwise as seen from the side of
// ∂p/∂u × ∂p/∂v.
void append_grid(MeshData& mesh, int columns, int rows, const std::function<GridPoint(float, float)>& at);

// pbrt's quadrics with its uv: u = φ / φmax. Parts of them (angles in radians); their areas are those of the
// round ones to within 10⁻³.
MeshData part_of_sphere(float radius, float z_min, float z_max, float phi_max);  // v runs from z_min to z_max
MeshData part_of_cylinder(float radius, float z_min, float z_max, float phi_max);
MeshData part_of_disk(float height, float radius, float inner_radius, float phi_max);  // v = 0 at the rim
// What a line of points, v from 0 to 1, passes over as it turns about z.
MeshData turned_about_z(const std::function<Vec3f(float)>& line, int rows, float phi_max);

}  // namespace lumirank::scenedesc::pbrt
