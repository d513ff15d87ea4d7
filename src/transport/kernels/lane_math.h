// Transcendental functions in lanes, by fixed polynomials: no library call, so the same bits in every build.
#pragma once

#include "transport/kernels/lanes.h"

namespace lumirank::transport {

// e^x for x ≤ 0, within 2 units in the last place; 0 below -87 (where a float would lose digits).
// Argument reduction by Cody and Waite: x = k·ln 2 + r, |r| ≤ ln 2 / 2, e^r by its Taylor series to r⁷.
inline Lane exp_negative(Lane x) {
  const LaneMask tiny = x < splat(-87.0f);
  const Lane y = max(x, splat(-87.0f));
  const Lane round = splat(12582912.0f);  // 1.5·2²³: adding it leaves an integer in the low bits
  const Lane shifted = y * splat(1.44269504088896341f) + round;
  const Lane k = shifted - round;
  const Lane r = (y - k * splat(0.693145751953125f)) - k * splat(1.42860677e-6f);
  Lane p = splat(1.0f / 5040);
  p = p * r + splat(1.0f / 720);
  p = p * r + splat(1.0f / 120);
  p = p * r + splat(1.0f / 24);
  p = p * r + splat(1.0f / 6);
  p = p * r + splat(0.5f);
  p = (p * r) * r + r + splat(1);
  // 2^k as the exponent bits of a float: k sits in the low bits of `shifted`.
  const LaneMask exponent = (reinterpret_cast<LaneMask>(shifted) + 127) << 23;
  return select(tiny, Lane{}, p * reinterpret_cast<Lane>(exponent));
}

}  // namespace lumirank::transport
