// Media that are nothing but the color of smooth glass or of a drink: they absorb and do not scatter, and
// light gets in and out by refraction alone. Rays take them in by Beer's law from one surface to the next,
// and nothing else of the scene needs to know that there are media.
#pragma once

#include <vector>

#include "base/rgb.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::world {

class World;

// Whether all media of the scene may be that, as far as the description tells.
bool may_color_glass(const scenedesc::SceneDesc& desc);

// By medium: how much is absorbed for each length of the file.
std::vector<Rgb> absorption_of_glass(const scenedesc::SceneDesc& desc);

// Whether rays inward from the surfaces of these media meet (with few exceptions) surfaces of media again,
// none that shadow rays pass: where something stands within, light that reaches it from there would be taken
// for unabsorbed.
bool colors_glass(const World& world);

}  // namespace lumirank::world
