// The sRGB transfer curve (IEC 61966-2-1).
#pragma once

#include <algorithm>
#include <cmath>

namespace lumirank::image {

// Linear [0, 1] to encoded [0, 1]; outside values are clamped and NaN becomes 0.
inline float srgb_encode(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

inline float srgb_decode(float encoded) {
  if (encoded <= 0.04045f) return encoded / 12.92f;
  return std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace lumirank::image
