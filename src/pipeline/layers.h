// Further layers of a picture: parts of the light, and what the eye's first hits know.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lumirank/lumirank.h"
#include "methods/method.h"
#include "pipeline/develop.h"

namespace lumirank::pipeline {

// Whether a layer is a part of the method's sums, by bounce or by light: that takes one combination of
// columns.
bool parts_light(const std::string& layer);
bool wants_illuminance(const RenderSettings& settings);

// Throws InputError where the method cannot give a layer, and names those that can: before anything is made.
void check_layers(const methods::MethodInfo& method, const RenderSettings& settings);

// Throws InputError for a light that the world does not have: before the render, not after it.
void check_lights(const world::World& world, const RenderSettings& settings, const Recipe& recipe);

// How often columns are gone over at most: by the method, and again for the layers that part its light.
int passes_over_columns(const RenderSettings& settings);

// Appends the planes that `layers` names, but for the illuminance. Cancelled, it leaves out those that are
// still to be computed from columns, warns, and returns false.
bool add_layers(Picture& picture, const Prepared& prepared, const TracedLight& traced,
                const methods::Estimate& estimate, const std::vector<std::string>& layers,
                const Sinks& sinks);

}  // namespace lumirank::pipeline
