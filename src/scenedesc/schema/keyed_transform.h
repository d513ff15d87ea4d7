// A transform between key frames: moved, turned and stretched apart, so that turns stay turns.
#pragma once

#include <vector>

#include "base/transform.h"

namespace lumirank::scenedesc {

struct TransformKey {
  double seconds = 0;
  Transform transform;
};

// The transform at `seconds`. `keys`: at least one, their times rising; before the first as at it, after the
// last as at that. Between two keys the translation and the stretch are interpolated linearly, the rotation
// spherically by the shorter way (the polar decomposition of Shoemake and Duff 1992, which Mitsuba and pbrt
// use too). Keys that mirror the scene in different ways have nothing in between: the earlier one is taken.
Transform transform_at(const std::vector<TransformKey>& keys, double seconds);

}  // namespace lumirank::scenedesc
