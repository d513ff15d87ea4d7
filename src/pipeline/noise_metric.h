// How large a picture's noise is, by the metric that its target for the error is of.
#pragma once

#include <string>

#include "image/image.h"
#include "lumirank/settings.h"

namespace lumirank::pipeline {

// The error (image/metrics.h) that a picture of no noise would have with this noise in it. `difference`:
// twice the noise, from independent halves.
double noise_by(ErrorMetric metric, const image::Image& picture, const image::Image& difference);

// More paths before it is asked again: FLIP of a large picture takes as long as a path for each pixel.
inline constexpr double kPathsToAskAgain = 1.1;

// For the notes of a report: what `error.estimate` is of. `of`: "passes" or "paths".
std::string said_of_noise(ErrorMetric metric, const char* of);

// Throws InputError if a metric is asked for that no estimate has: only pictures of passes or paths know
// their noise in every pixel.
void check_metric(const MethodSettings& method, bool passes_or_paths);

}  // namespace lumirank::pipeline
