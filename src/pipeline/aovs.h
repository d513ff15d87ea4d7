// Further layers of a picture: parts of the light, and what the eye's first hits know.
#pragma once

#include "lumirank/lumirank.h"
#include "pipeline/pipeline.h"

namespace lumirank::pipeline {

// What `--only` leaves of the picture.
FilmParts wanted_parts(const RenderSettings& settings);

// Whether a layer is a part of the method's sums, by bounce or by light: that takes one combination of
// columns.
bool parts_light(const std::string& aov);

// Throws InputError where the method cannot give a layer, and names those that can: before anything is made.
void check_layers(const methods::MethodInfo& method, const RenderSettings& settings);

// Throws InputError for a light that the world does not have: before the render, not after it.
void check_aovs(const world::World& world, const RenderSettings& settings);

// How often columns are gone over at most: by the method, and again for the layers that part its light.
int passes_over_columns(const RenderSettings& settings);

// Appends the planes that settings.aovs names. Throws InputError where a method's estimate cannot be split by
// light. Cancelled, it leaves out those that are still to be computed from columns, warns, and returns false.
bool add_aovs(Picture& picture, const Setup& setup, const RenderSettings& settings,
              const methods::Estimate& estimate, const Sinks& sinks);

}  // namespace lumirank::pipeline
