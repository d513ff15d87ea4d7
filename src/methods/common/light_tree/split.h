// Division of a set of lights in two.
#pragma once

#include <cstdint>
#include <span>

#include "base/vec.h"
#include "matrix/entry_bounds.h"

namespace lumirank::methods {

// What the division knows of a light: where it is (nothing, if infinitely far), where it faces (nothing,
// if everywhere), how strong.
struct SplitLight {
  Vec3f position, direction;
  float intensity;
  matrix::Index column;
};

// Reorders `lights` so that the first of the two halves comes first; returns its size, at least 1 and less
// than all. `across`: c of the measure, what a turn counts beside a distance. Of as many cuts as there are
// bins the best by Σ intensity·(diagonal² + c²·(1 - cos)²), 1 - cos by the box that the directions fill.
// The same result on any number of threads.
std::size_t split_lights(std::span<SplitLight> lights, float across);

}  // namespace lumirank::methods
