// Reader of glTF scenes.
#pragma once

#include <string>

#include "scenedesc/schema/read_options.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// glTF 2.0, .gltf or .glb (by the first bytes).
SceneDesc read_gltf(const std::string& filename, const ReadOptions& options = {});
// The same from memory; other files are taken from the folder of `filename`.
SceneDesc parse_gltf(const std::string& bytes, const std::string& filename, const ReadOptions& options = {});

}  // namespace lumirank::scenedesc
