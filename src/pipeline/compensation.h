// Light that clamping took, given back by path tracing.
#pragma once

#include "image/image.h"
#include "lumirank/settings.h"
#include "pipeline/prepared.h"

namespace lumirank::pipeline {

// Adds what clamping took from the indirect light of the prepared columns, by settings.traced.compensate
// paths per pixel. False if it was interrupted: the image is then as it was.
bool compensate_clamping(const Prepared& prepared, const RenderSettings& settings, image::Image& image,
                         const Sinks& sinks);

}  // namespace lumirank::pipeline
