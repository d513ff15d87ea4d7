// Says beforehand why a picture will show nothing.
#pragma once

#include <string>

#include "world/view.h"
#include "world/world.h"

namespace lumirank::pipeline {

// "" if an eye ray of a coarse grid over the picture meets a surface, or the background shines and no
// clipping plane hides a surface; else what is the matter, and the remedy.
std::string empty_view(const world::World& world, const world::View& view);

}  // namespace lumirank::pipeline
