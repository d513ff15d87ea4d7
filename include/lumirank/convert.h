// Scenes of any format as Mitsuba 3 XML.
#pragma once

#include <string>
#include <vector>

#include "lumirank/export.h"
#include "lumirank/lumirank.h"

namespace lumirank {

// Writes the scene to `filename` (.xml), and beside it the meshes, pictures, volumes and curves that the
// scene file itself holds; other files are referred to. Each file is whole or absent. What Mitsuba 3 cannot
// say is warned of. Returns the names of what was written, the scene last. Throws InputError if one of them
// is an input of the scene, or cannot be written.
LUMIRANK_API std::vector<std::string> convert(const Scene& scene, const std::string& filename,
                                              const Sinks& sinks = {});

}  // namespace lumirank
