// How readers say what a format has and Lumirank does not.
#pragma once

#include <string>

#include "scenedesc/readers.h"

namespace lumirank::scenedesc {

// With `options.strict` an InputError. `used_instead`: "" if it is left out.
void add_warning(SceneDesc& scene, const ReadOptions& options, const SourceLocation& where,
                 const std::string& what, const std::string& used_instead);

// A note, for what no picture shows or what is no replacement at all: --strict lets it pass.
void add_note(SceneDesc& scene, const SourceLocation& where, const std::string& what);

}  // namespace lumirank::scenedesc
