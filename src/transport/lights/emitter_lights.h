// Direct columns: virtual lights that stand for the emitters themselves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "transport/lights/light_record.h"
#include "world/emitter_choice.h"
#include "world/world.h"

namespace lumirank::transport {

// How many direct columns a world needs at least: one per emitter that shines (16 for a sun with a disc).
// Area and environment light can use any number.
struct DirectNeed {
  std::size_t min_count = 0;
  bool sampled = false;  // some emitter can use more
};
DirectNeed direct_need(const world::World& world, const world::EmitterChoice& choice);

// About `count` lights for all emitters together. If there are more emitters than half of `count`, a
// stratified choice of them by power stands for all; otherwise every one gets its own, the larger ones more.
LightBatch emitter_lights(const world::World& world, const world::EmitterChoice& choice, std::uint64_t seed,
                          std::size_t count);

// How many lights each emitter gets, by its name: fixed for all moments of a scene, so that their lights are
// the same lights.
struct EmitterCounts {
  std::map<std::string, std::size_t> of;
};
// For emitters of these worlds, by their power in the mean.
EmitterCounts count_emitter_lights(std::span<const world::World* const> worlds, std::size_t count);
// Ids and random numbers belong to the emitters' names. An emitter that the counts lack, because it was dark
// or absent whenever they were made, gets as many as the least of its kind.
LightBatch emitter_lights(const world::World& world, const EmitterCounts& counts, std::uint64_t seed);

}  // namespace lumirank::transport
