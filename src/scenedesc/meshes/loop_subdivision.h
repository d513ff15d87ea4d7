// Loop's subdivision surfaces (Loop 1987, "Smooth Subdivision Surfaces Based on Triangles"), with the weights
// of Warren and Weimer 2002 for vertices of any valence.
#pragma once

#include "scenedesc/schema/mesh.h"

namespace lumirank::scenedesc {

// The control mesh's positions and indices, divided `levels` times and moved to the limit surface, with
// normals. Edges of one triangle, or of more than two, are boundaries: the surface ends there in a cubic
// B-spline of the boundary's own vertices.
MeshData loop_subdivided(const MeshData& control, int levels);

}  // namespace lumirank::scenedesc
