// Eye segments put together where they are alike, and in slices of those that are (Huo et al. 2016, section
// 4).
#pragma once

#include <cstdint>
#include <span>

#include "base/sinks.h"
#include "transport/rows/eye_segments.h"
#include "world/world.h"

namespace lumirank::transport {

struct EyeGroupSettings {
  std::uint64_t seed = 1;
  double groups_per_ray = 0.008;  // section 4.3
  bool refine = true, merge = true;
};

// Cuts and merges the segments where the groups of their graph want it, and fills EyeSegments::slice. `film`:
// places of the film samples. The film is divided into stretches of some thousand rays, each with a graph of
// its own, so that memory does not grow with the film; stretches are compact, since film samples are numbered
// along a space-filling curve. Deterministic in the seed.
void group_eye_segments(const world::World& world, std::span<const Vec2f> film,
                        const EyeGroupSettings& settings, EyeSegments& segments, const Sinks& sinks = {});

// Puts neighbors on a ray together that are alike by more than `merge_above` of 4 (SegmentSimilarity), so
// that many short segments are left only where one place could not stand for them. Deterministic in the seed.
void merge_eye_segments(const world::World& world, std::span<const Vec2f> film, float merge_above,
                        std::uint64_t seed, EyeSegments& segments, const Sinks& sinks = {});

}  // namespace lumirank::transport
