// The frames of a part of a shot by tensor clustering.
#pragma once

#include <vector>

#include "lumirank/animate.h"

namespace lumirank::api {

// Throws InputError for numbers out of range, and for what a render can be asked for and tensor clustering
// does not do.
void check(const TensorSettings& tensor, const RenderSettings& settings);

// One picture and report for each scene, which are one scene at moments one after the other; none if it was
// cancelled.
std::vector<RenderResult> render_tensor(const std::vector<Scene>& scenes, const RenderSettings& settings,
                                        const TensorSettings& tensor, const Sinks& sinks);

}  // namespace lumirank::api
