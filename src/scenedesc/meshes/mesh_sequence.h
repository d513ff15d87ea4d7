// Mesh sequences: numbered files of one mesh that deforms (schema/frame_files.h).
#pragma once

#include <string>

#include "scenedesc/schema/shapes.h"

namespace lumirank::scenedesc {

// Throws InputError, naming both files, if the mesh in `bytes`, which are those of `file`, has not as many
// vertices, and the same faces, as that of the sequence's first file: it is another mesh then, and what moves
// from one to the other is not known. Nothing for a file of no sequence.
void check_sequence(const MeshFileDesc& file, const std::string& bytes);

}  // namespace lumirank::scenedesc
