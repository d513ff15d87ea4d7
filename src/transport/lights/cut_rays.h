// Ray lights in pieces: short ones stand in a tree of lights where their light comes from.
#pragma once

#include <span>
#include <vector>

#include "base/random.h"
#include "transport/lights/ray_lights.h"

namespace lumirank::transport {

// Appends the pieces of ray j to `out`: the first `ends.size()` of them end there along it (ascending, the
// last is its length). Their powers are what of the ray's arrives at their origins; a piece that gets nothing
// and those behind it are left out. Appends to `passed` what each lets through. `branch` is left alone.
void append_pieces(const world::World& world, const RayLights& rays, std::size_t j,
                   std::span<const float> ends, Rng& rng, RayLights& out, std::vector<Rgb>& passed);
// A piece of it from `offset` on.
void append_piece(const RayLights& rays, std::size_t j, float offset, float length, Rgb power,
                  std::uint64_t id, RayLights& out);

// All rays in pieces of at most the same length each: about `pieces` times as many, at most kMostPieces of a
// ray. Deterministic in the seed, which transmittances through uneven media are tracked with.
inline constexpr std::size_t kMostPieces = 64;
RayLights cut_evenly(const world::World& world, const RayLights& rays, double pieces, std::uint64_t seed);

}  // namespace lumirank::transport
