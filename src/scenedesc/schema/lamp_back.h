// Lamps of two sides are two shapes, so that nothing in transport needs to know of them.
#pragma once

#include "scenedesc/schema/mesh.h"
#include "scenedesc/schema/shapes.h"

namespace lumirank::scenedesc {

// The lamp's back: the same surface turned round, 10⁻⁴ of its size behind the front. For spheres and inline
// meshes with at least one triangle.
ShapeDesc back_of(const ShapeDesc& front);

// Whether the triangles close a volume, seen from outside: then nobody sees their backs. Corners at the same
// place are one.
bool is_closed_outwards(const MeshData& mesh);

}  // namespace lumirank::scenedesc
