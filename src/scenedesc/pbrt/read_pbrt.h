// Reader of pbrt scenes.
#pragma once

#include <string>

#include "scenedesc/schema/read_options.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// pbrt-v4, or pbrt-v3 if it ends with WorldEnd. Names of files are relative to the folder of `filename`.
SceneDesc read_pbrt(const std::string& filename, const ReadOptions& options = {});
SceneDesc parse_pbrt(const std::string& text, const std::string& filename, const ReadOptions& options = {});

}  // namespace lumirank::scenedesc
