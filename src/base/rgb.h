// Linear RGB triples (Rec. 709 primaries). Radiance, flux or reflectance: the owner says which.
#pragma once

#include <algorithm>
#include <cmath>

#include "lumirank/values.h"

namespace lumirank {

inline float luminance(Rgb c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }
inline float max_component(Rgb c) { return std::max(c.r, std::max(c.g, c.b)); }
inline float mean(Rgb c) { return (c.r + c.g + c.b) * (1.0f / 3.0f); }
inline bool is_black(Rgb c) { return c.r == 0 && c.g == 0 && c.b == 0; }
inline bool is_finite(Rgb c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }
// The scalar that the papers take for an RGB entry: the 2-norm of the triple (2007, section 3.2).
inline float norm2(Rgb c) { return std::sqrt(c.r * c.r + c.g * c.g + c.b * c.b); }
inline Rgb lerp(Rgb a, Rgb b, float t) { return a + (b - a) * t; }
inline Rgb clamp_below(Rgb c, float hi) { return {std::min(c.r, hi), std::min(c.g, hi), std::min(c.b, hi)}; }
inline Rgb sqrt(Rgb c) { return {std::sqrt(c.r), std::sqrt(c.g), std::sqrt(c.b)}; }

}  // namespace lumirank
