// A scene at the instants of an open shutter.
#pragma once

#include <vector>

#include "lumirank/lumirank.h"
#include "pathtrace/reference.h"

namespace lumirank::api {

// So many worlds with their views, from the scene's moment on (that of its first key if it has none);
// instants at which nothing has moved share theirs. `media`: participating media too. Reports the warnings of
// the first. Throws InputError, Cancelled.
std::vector<pathtrace::Instant> open_shutter(const Scene& scene, const RenderSettings& settings,
                                             std::size_t count, bool media, const Sinks& sinks);

}  // namespace lumirank::api
