// Adaptive LightSlice (Frederickx, Bartels, Dutré, "Adaptive LightSlice for Virtual Ray Lights", Eurographics
// 2015, short papers): LightSlice whose slices split their clusters until these err by less than a given
// share of the slice's light, as the rows that were read tell.
//
// Deviation: that error is the square root of the clusters' cost (Hašan et al. 2007, section 3.4), by which
// they are split, over the sum of their columns' norms.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo adaptive_lightslice_info();

}  // namespace lumirank::methods
