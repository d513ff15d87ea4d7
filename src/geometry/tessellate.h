// Meshes of the analytic shapes, in their local frames. The curved ones carry exact normals and uv.
#pragma once

#include "geometry/mesh.h"

namespace lumirank::geometry {

TriangleMesh make_rectangle();                               // [-1,1]², z = 0, normal +z
TriangleMesh make_cube();                                    // [-1,1]³
TriangleMesh make_disk(int segments = 128);                  // unit disk, z = 0, normal +z
TriangleMesh make_sphere(Vec3f center, float radius, int rings = 64);
TriangleMesh make_cylinder(Vec3f p0, Vec3f p1, float radius, int segments = 128);  // open

}  // namespace lumirank::geometry
