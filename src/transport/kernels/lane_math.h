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

// ln x for finite x > 0 that are not denormal, within 3 units in the last place (1e-7 where |ln x| < 1 is
// small): x = 2^e·m with m in [√½, √2), and ln m = 2·artanh(s), s = (m - 1)/(m + 1), |s| < 0.172, by its
// Taylor series to s⁹.
inline Lane log_positive(Lane x) {
  const LaneMask bits = reinterpret_cast<LaneMask>(x);
  const LaneMask shifted = bits - 0x3f3504f3;  // the bits of √½: the exponent counts from there
  const LaneMask e = shifted >> 23;
  const Lane m = reinterpret_cast<Lane>(bits - (e << 23));
  const Lane k = __builtin_convertvector(e, Lane);
  const Lane f = m - splat(1);
  const Lane s = f / (splat(2) + f), s2 = s * s;
  Lane p = splat(1.0f / 9);
  p = p * s2 + splat(1.0f / 7);
  p = p * s2 + splat(1.0f / 5);
  p = p * s2 + splat(1.0f / 3);
  // 2s = f - s·f, so that f's digits are kept.
  const Lane small = f - s * (f - splat(2) * s2 * p);
  return k * splat(0.693145751953125f) + (k * splat(1.42860677e-6f) + small);
}

// The angle in [0, π/2] of a direction with the given cosine and sine; Abramowitz and Stegun 4.4.46, 2e-8.
inline Lane angle_of(Lane cosine, Lane sine) {
  Lane p = splat(-0.0012624911f);
  p = p * cosine + splat(0.0066700901f);
  p = p * cosine + splat(-0.0170881256f);
  p = p * cosine + splat(0.0308918810f);
  p = p * cosine + splat(-0.0501743046f);
  p = p * cosine + splat(0.0889789874f);
  p = p * cosine + splat(-0.2145988016f);
  p = p * cosine + splat(1.5707963050f);
  return sine / sqrt(splat(1) + cosine) * p;
}

}  // namespace lumirank::transport
