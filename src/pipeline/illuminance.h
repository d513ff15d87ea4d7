// The layer "illuminance": lux at the surfaces that the eye meets first, whatever they are made of.
#pragma once

#include <optional>

#include "image/image.h"
#include "methods/method.h"
#include "pipeline/prepared.h"

namespace lumirank::pipeline {

// A second matrix: the same lights, and a white diffuse receiver at each first hit, whose radiance is E/π.
// The method runs on it as on the first. The three channels are equal: π · lumens_per_unit · luminance.
// Nothing if it was cancelled.
std::optional<image::Image> render_illuminance(const Prepared& prepared, const methods::Method& method,
                                               const methods::RunOptions& run, double lumens_per_unit);

}  // namespace lumirank::pipeline
