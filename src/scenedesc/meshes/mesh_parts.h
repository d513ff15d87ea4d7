// Shared by the mesh readers: checks of what was read, and the making of normals. Internal to this room.
#pragma once

#include <cstdint>
#include <string>

#include "scenedesc/schema/mesh.h"

namespace lumirank::scenedesc {

// Every corner must be the number of a vertex; the caller has checked that. Leaves degenerate triangles
// out, gives normals that are missing (zero or not finite) the direction of the faces around them, replaces
// uvs and colors that are not finite by 0, and notes what it did to vertices in use; there may be no
// triangle left. InputError if a vertex is not finite.
MeshData checked(MeshData mesh, const std::string& filename);

// Angle-weighted normals of the vertices (Thürmer and Wüthrich 1998), shared over all triangles with the same
// index.
void make_smooth_normals(MeshData& mesh);

// New normals, averaged over the triangles that meet at a place and are connected there by edges flatter than
// `max_angle` degrees. Splits vertices at creases.
void make_creased_normals(MeshData& mesh, float max_angle);

// As parse_serialized; `face_normals` tells whether the file asks for flat shading.
MeshData parse_serialized(const std::string& bytes, const std::string& filename, int shape_index,
                          bool& face_normals);

}  // namespace lumirank::scenedesc
