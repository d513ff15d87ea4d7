// Meshes of the analytic shapes, in their local frames, with Mitsuba's uv. Vertices and normals of the curved
// ones are exact, so their area is that of the inscribed polyhedron: too small by 0.050 % (sphere), 0.040 %
// (disk) and 0.010 % (cylinder) at the default fineness, and in proportion to 1 / fineness². Corners run
// counter-clockwise as seen from outside (from +z for the flat ones). Sizes that are not positive and finite
// throw InputError.
#pragma once

#include "geometry/mesh.h"

namespace lumirank::geometry {

TriangleMesh make_rectangle();               // [-1,1]², z = 0, normal +z; uv (x+1)/2, (y+1)/2
TriangleMesh make_cube();                    // [-1,1]³, uv [0,1]² on each side
TriangleMesh make_disk(int segments = 128);  // unit disk, z = 0, normal +z; u = r, v = φ/2π
TriangleMesh make_sphere(Vec3f center, float radius, int rings = 64);  // 2·rings segments; u = φ/2π, v = θ/π
// Open; u = φ/2π, v runs from 0 at p0 to 1 at p1.
TriangleMesh make_cylinder(Vec3f p0, Vec3f p1, float radius, int segments = 128);

}  // namespace lumirank::geometry
