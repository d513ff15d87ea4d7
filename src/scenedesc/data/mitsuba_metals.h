// Metals by the names that Mitsuba has for them.
#pragma once

#include <optional>
#include <string>

#include "scenedesc/data/ior.h"

namespace lumirank::scenedesc {

// As Mitsuba shows them; where it does not know the name, by our own measurements (ior.h).
std::optional<MetalIndex> mitsuba_metal(const std::string& name);
std::string mitsuba_metal_names();

}  // namespace lumirank::scenedesc
