// Notes about a scene, and what stands in for files that are missing. Warnings: SceneReader (scene_reader.h).
#pragma once

#include <string>

#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// A note, for what no picture shows or what is no replacement at all: --strict lets it pass.
void add_note(SceneDesc& scene, const SourceLocation& where, const std::string& what);

// What is shown in place of pictures; TextureBuilder and MaterialBuilder do it.
inline constexpr const char* kMissingPicture =
    "squares of magenta and gray (as a number 0.5, as an opacity 1, as bumps none)";
// In place of BSDFs whose file is missing.
inline constexpr const char* kMissingBsdf = "diffuse, gray 0.5";
// In place of environments: `scale` times this.
inline constexpr float kMissingSky = 0.5f;

}  // namespace lumirank::scenedesc
