// Receivers of their own for film samples that see what no receiver near them sees.
#pragma once

#include "base/sinks.h"
#include "transport/rows/receivers.h"
#include "world/camera.h"
#include "world/world.h"

namespace lumirank::transport {

// `receivers` and those that the film samples of its pixels lack, all in the order that Receivers has. Film
// samples of a pixel that see the same surface share one; a pixel gets at most as many as kMaxAdded of its
// receivers, for those of its surfaces that it shows most of. Their weight is that of all the film samples
// they stand for, so that methods know what they are worth. `corner`: the upper left pixel of the window; at
// its edges, where neighbors are missing that the whole film has, none are added.
inline constexpr float kMaxAdded = 0.5f;
Receivers with_film_receivers(const world::World& world, const world::Camera& camera,
                              const ReceiverSettings& settings, Vec2i corner, Receivers receivers,
                              const Sinks& sinks);

// Whether the window of receivers has all of a pixel's neighbors that the whole film has.
bool has_neighbors(const world::Camera& camera, const Receivers& receivers, Vec2i corner, Vec2i pixel);

}  // namespace lumirank::transport
