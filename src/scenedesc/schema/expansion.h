// A guard against descriptions that are small files and huge scenes.
#pragma once

#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// An InputError, at its place, for the first BSDF or texture that is made of more others than any picture
// could mean (each use counts: mixtures of mixtures double), or of itself, and for groups of shapes that are
// placed more often than any memory could hold. Every reader ends with it.
void check_expansion(const SceneDesc& scene);

}  // namespace lumirank::scenedesc
