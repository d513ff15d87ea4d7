// Readers of mesh and curve files. Every function throws InputError with file, line and remedy, whatever the
// bytes are.
#pragma once

#include <string>

#include "base/error.h"
#include "scenedesc/schema/shapes.h"

namespace lumirank::scenedesc {

MeshData read_mesh(const MeshFileDesc& file);
// From memory; `filename` only names the source in messages. Indices are validated, non-finite vertices are
// an error, degenerate triangles are left out, and all that was mended is noted. A mesh that has no triangle,
// or none with an area, comes out empty: the world leaves it out.
MeshData parse_obj(const std::string& bytes, const std::string& filename);
MeshData parse_ply(const std::string& bytes, const std::string& filename);
MeshData parse_serialized(const std::string& bytes, const std::string& filename, int shape_index);

// For readers whose scene files hold meshes themselves: what parse_* do to every mesh. Lists that are not as
// long as the positions and indices beyond them are an error at `where`, as is a vertex that is not finite;
// the rest is mended and noted, and there may be no triangle left.
MeshData check_mesh(MeshData mesh, const SourceLocation& where);

// The points of curves, from their file where they have one; none if it holds no curve. Text: "x y z radius"
// in every line, or "x y z" where file_radius is given; empty lines part the curves. With file_radius also
// the binary form of Mitsuba 0.6. InputError also where a curve has fewer points than its basis needs.
CurvesDesc read_curves(const CurvesDesc& curves);
CurvesDesc parse_curves(const std::string& bytes, const CurvesDesc& curves);

}  // namespace lumirank::scenedesc
