// The lobes that make up most scenes, evaluated in lanes: line by line after scatter/microfacet.h, fresnel.h
// and interface.h, where the formulas and their sources are.
#pragma once

#include "transport/pairs/scatter_group.h"

namespace lumirank::transport {

// Folds what depends on wo alone into the lobes' colors and sets `answers`. All plain parameters are in
// place.
void prepare(ScatterGroup& group, LobeLanes* lobes, CoatLanes* coats);

// Σ f(wo, wi) of a prepared group whose form has lane code.
Lane3 eval_lobes(const ScatterGroup& group, const Lane3& wi, LaneMask direct);

}  // namespace lumirank::transport
