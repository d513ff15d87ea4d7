// The same virtual lights at several moments of a scene in which nothing but participating media moves
// (ours): rays and points that stay where they are while their power follows the smoke, so that what is made
// of them does not flicker.
//
// A particle is traced through the media of one moment, which is drawn, and its light is told for every
// moment: what it would carry there over the mean density of all moments and channels along the same way (the
// balance heuristic, Veach and Guibas, "Optimally combining sampling techniques for Monte Carlo rendering",
// 1995). So no moment lacks light where another one's media are empty. Each moment's lights have its own
// expectation, but for what media::DepthProfile misses between the places that it looks at.
#pragma once

#include <span>
#include <vector>

#include "transport/lights/ray_lights.h"

namespace lumirank::transport {

// Whether surfaces and emitters are in all worlds the same, so that trace_lights_of_moments() may be asked.
bool only_media_differ(std::span<const world::World* const> worlds);

// Of every world: in all of them column j is the same light, and but for its power alike. As
// trace_lights_in_media() otherwise. At least one world.
std::vector<LightsInMedia> trace_lights_of_moments(std::span<const world::World* const> worlds,
                                                   const MediaLightSettings& settings,
                                                   const Sinks& sinks = {});

}  // namespace lumirank::transport
