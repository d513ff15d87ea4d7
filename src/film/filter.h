// Reconstruction filters: how receivers become pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "image/image.h"

namespace lumirank::film {

enum class FilterKind { box, tent, gaussian, mitchell, catmullrom, lanczos };
// The profiles and defaults of Mitsuba. The cubic filters do not stretch with the radius, they are only cut
// by it.
struct Filter {
  FilterKind kind = FilterKind::box;
  float radius = 0.5f;
  float stddev = 0.5f, b = 1.0f / 3, c = 1.0f / 3;
  int lobes = 3;
  float eval(float x) const;  // 1-D profile of (sample - pixel center); 0 beyond the radius
  // A sample in pixel p counts for pixels p ± reach() at most.
  int reach() const;
  static Filter standard(FilterKind kind);  // with the radius that suits the kind
};

// Image of samples at film positions (pixels) in a width × height window of the film whose upper left pixel
// is `corner`: every pixel is the weighted mean of the samples under the filter. Values are divided by the
// sum of weights; where negative lobes nearly cancel that sum, the weights' magnitudes are taken instead. A
// pixel that no sample reaches is black. The order of sums is fixed. Samples outside the window count as far
// as the filter reaches, so a window has the bits that the whole has there. Throws InternalError if the spans
// differ in length or a position is not finite.
image::Image splat(int width, int height, const Filter& filter, std::span<const Vec2f> positions,
                   std::span<const Rgb> values, Vec2i corner = {0, 0});

}  // namespace lumirank::film
