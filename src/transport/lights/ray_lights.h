// Columns in participating media: virtual ray lights (Novák, Nowrouzezahrai, Dachsbacher, Jarosz, "Virtual
// ray lights for rendering scenes with participating media", 2012). Every flight of a particle through a
// medium is one: from where it started to the next surface, wherever the particle itself collided before
// that, so that its light scatters from all of the way in the expectation.
#pragma once

#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "base/sinks.h"
#include "base/vec.h"
#include "transport/lights/virtual_lights.h"
#include "world/world.h"

namespace lumirank::transport {

// Column j is what scatters out of the light that flies along origin + s·direction, 0 ≤ s ≤ length.
struct RayLights {
  std::vector<Vec3f> origin, direction;  // unit
  std::vector<float> length;
  std::vector<std::int16_t> medium;    // index into World::media()
  std::vector<Rgb> power;              // flux at the origin
  std::vector<std::uint16_t> emitter;  // first emitter of the path
  std::vector<std::uint16_t> depth;    // path segments from the emitter to here, this one included
  std::vector<std::uint32_t> path;     // the particle
  std::vector<std::uint8_t> half;      // as in VirtualLights
  std::vector<std::uint64_t> id;       // who it is, as in VirtualLights
  std::vector<std::uint64_t> branch;   // place in a tree (ray_tree.h), as matrix::ColumnFeatures; empty: none

  std::size_t size() const { return origin.size(); }
  bool empty() const { return origin.empty(); }
  std::size_t memory_bytes() const {
    return size() * (2 * sizeof(Vec3f) + sizeof(Rgb) + 4 + 2 + 2 + 2 + 4 + 1 + 8) + 8 * branch.size();
  }
};

// Emitters and surfaces as points, flights as rays.
struct LightsInMedia {
  VirtualLights points;
  RayLights rays;
};

struct MediaLightSettings {
  std::uint64_t seed = 1;
  std::size_t count = 100000;  // of points and rays together, about
  int max_depth = -1;          // Mitsuba's count
  Vec3f eye{};                 // where the camera is
  int eye_medium = -1;         // and in what, see world::EmitterMedia
  bool direct = true, indirect = true;
  // An emitter's column with more than one part of so many of all emitters' light stands there several times,
  // each time with a part of the power, and what a segment gets from it is estimated at as many places.
  std::size_t least_direct = 0;
};

// Deterministic in the seed. Emitters get a quarter of the lights where they can use so many; the number of
// particles follows from a pilot, so the true count is near, not exactly, the target.
LightsInMedia trace_lights_in_media(const world::World& world, const MediaLightSettings& settings,
                                    const Sinks& sinks = {});

}  // namespace lumirank::transport
