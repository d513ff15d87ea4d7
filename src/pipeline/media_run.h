// One render of a world with participating media: receivers and eye segments × points and rays.
#pragma once

#include "pipeline/render_run.h"

namespace lumirank::pipeline {

// Whether a medium of the scene may scatter. Those that only absorb need no rows and columns of their own.
bool some_scatter(const scenedesc::SceneDesc& desc);

// Throws InputError for what a picture in empty space can be asked for and one with media cannot: layers,
// light traced beside the columns, spherical lights.
void check_media(const methods::MethodInfo& method, const RenderSettings& settings);
void check_media(const RenderSettings& settings);  // whatever the method

// The method for such a scene, where "auto" is row-column-sampling; `why` (may be nullptr) says so.
const methods::MethodInfo& chosen_method_in_media(const RenderSettings& settings, std::string* why = nullptr);

// Under a time budget passes with fresh rows and columns are averaged for as long as another one fits.
RenderResult run_in_media(RenderTask task, const RenderSettings& settings, const Sinks& sinks,
                          const PreviewCallback& on_preview);

}  // namespace lumirank::pipeline
