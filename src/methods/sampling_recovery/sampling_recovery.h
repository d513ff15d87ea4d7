// Matrix sampling and recovery (Huo et al. 2015, "A matrix sampling-and-recovery approach for many-lights
// rendering"): slices of receivers, clusters of lights per slice, few visibilities sampled, the others
// predicted and recovered as a matrix of low rank.
//
// Slices and clusters are those of slice-cuts. Where we deviate in the rest: section 7.2's super-samples
// share their pixel's visibility, but each keeps its own shading; samples of a column follow one of four
// evenly spread orders instead of uniform draws; predictors are judged by their probabilities; the separation
// fits all entries (linalg/separation.h). Biased: what is recovered is no estimate of a sum.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo sampling_recovery_info();

}  // namespace lumirank::methods
