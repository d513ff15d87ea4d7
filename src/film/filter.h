// Reconstruction filters: how receivers become pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "film/image.h"

namespace lumirank::film {

enum class FilterKind { box, tent, gaussian, mitchell, catmullrom, lanczos };
struct Filter {
  FilterKind kind = FilterKind::box;
  float radius = 0.5f;
  float stddev = 0.5f, b = 1.0f / 3, c = 1.0f / 3;
  int lobes = 3;
  float eval(float x) const;  // 1-D profile; 0 beyond the radius
};

// Image of samples at film positions (pixels; (0,0) upper left of a width × height window): every pixel is the weighted mean of the
// samples under the filter. Values are divided by the sum of weights. The order of sums is fixed.
Image splat(int width, int height, const Filter& filter, std::span<const Vec2f> positions,
            std::span<const Rgb> values);

}  // namespace lumirank::film
