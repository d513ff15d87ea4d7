// The light clusters of matrix sampling and recovery (Huo et al. 2015, section 4) with all visibilities of
// theirs: for every slice of receivers a cut of the light tree, and a traced visibility for every surface of
// a pixel and column.
//
// Shadow rays in packets cost so little that tracing all of a slice's visibilities takes no longer than
// recovering them from few (docs/measurements.md), and leaves the error of the clusters alone. Where the
// clusters deviate from the paper, slice_cut.h says.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo slice_cuts_info();

}  // namespace lumirank::methods
