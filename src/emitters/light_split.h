// Division of a group of lights in two, for light trees. Inside this room only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "emitters/light_bound.h"

namespace lumirank::emitters {

struct LightItem {
  LightBound bound;
  Vec3f center;
  std::uint32_t light = 0;
};

LightBound join_all(std::span<const LightItem> items);

// Orders at least two items so that the first part and the rest are a good pair of children; returns the size
// of the first part, neither 0 nor all.
std::size_t split_lights(std::span<LightItem> items);

}  // namespace lumirank::emitters
