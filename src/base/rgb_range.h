// The least and the most of each channel.
#pragma once

#include <algorithm>

#include "base/rgb.h"

namespace lumirank {

inline Rgb min_of(Rgb a, Rgb b) { return {std::min(a.r, b.r), std::min(a.g, b.g), std::min(a.b, b.b)}; }
inline Rgb max_of(Rgb a, Rgb b) { return {std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)}; }

}  // namespace lumirank
