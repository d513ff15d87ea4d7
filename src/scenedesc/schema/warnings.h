// Warnings of readers: what a format has and Lumirank does not.
#pragma once

#include <string>

#include "scenedesc/schema/read_options.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// With `options.strict` an InputError. `used_instead`: "" if it is left out.
void add_warning(SceneDesc& scene, const ReadOptions& options, const SourceLocation& where,
                 const std::string& what, const std::string& used_instead);

// A note, for what no picture shows or what is no replacement at all: --strict lets it pass.
void add_note(SceneDesc& scene, const SourceLocation& where, const std::string& what);

// The scene names a file that does not exist; `what` says what it is and its name: "texture not found:
// a.png". An InputError, or with `options.allow_missing` a warning that `stand_in` is in its place ("": it is
// left out).
void missing_file(SceneDesc& scene, const ReadOptions& options, const SourceLocation& where,
                  const std::string& what, const std::string& stand_in);

// What is shown in place of pictures; TextureBuilder and MaterialBuilder do it.
inline constexpr const char* kMissingPicture =
    "squares of magenta and gray (as a number 0.5, as an opacity 1, as bumps none)";
// In place of BSDFs whose file is missing.
inline constexpr const char* kMissingBsdf = "diffuse, gray 0.5";
// In place of environments: `scale` times this.
inline constexpr float kMissingSky = 0.5f;

}  // namespace lumirank::scenedesc
