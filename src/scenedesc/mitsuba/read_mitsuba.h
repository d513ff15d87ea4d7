// Reader of Mitsuba scenes.
#pragma once

#include <string>

#include "scenedesc/schema/read_options.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// Mitsuba XML, 0.6 and 3.x (by the version attribute).
SceneDesc read_mitsuba(const std::string& filename, const ReadOptions& options = {});
// The same from memory (tests, fuzzing); relative names are taken from the folder of `filename`.
SceneDesc parse_mitsuba(const std::string& text, const std::string& filename,
                        const ReadOptions& options = {});

}  // namespace lumirank::scenedesc
