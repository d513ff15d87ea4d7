// A scene description as text.
#pragma once

#include <string>

#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// Human-readable listing of what there is, for `lumirank info` and debugging; without the warnings.
std::string describe(const SceneDesc& scene);

}  // namespace lumirank::scenedesc
