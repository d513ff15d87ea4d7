// Transcendental functions in lanes, by fixed polynomials: no library call, so the same bits in every build.
#pragma once

#include "base/lanes.h"

namespace lumirank {

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

// Inverse hyperbolic sine, within 2e-7 and as much of its size.
inline Lane arsinh(Lane x) {
  const Lane a = abs(x);
  const Lane r = log_positive(a + sqrt(a * a + splat(1)));
  return select(x < Lane{}, -r, r);
}

// Hyperbolic sine for |x| < 87, within 2e-7 and 4e-7 of its size.
inline Lane sinh(Lane x) {
  const Lane e = exp_negative(-abs(x));
  const Lane r = splat(0.5f) * (splat(1) / e - e);
  return select(x < Lane{}, -r, r);
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

inline Lane floor(Lane a) {
  const Lane whole = __builtin_convertvector(__builtin_convertvector(a, LaneMask), Lane);
  return whole - select(whole > a, splat(1), Lane{});
}

// sin 2πv and cos 2πv for 0 ≤ v ≤ 1, within 3e-7: reduced to an eighth of a turn, then Taylor series.
inline void sin_cos_turns(Lane v, Lane& sine, Lane& cosine) {
  const Lane quarters = floor(v * splat(4) + splat(0.5f));
  const Lane x = (v * splat(4) - quarters) * splat(1.57079632679489662f), x2 = x * x;
  const Lane s = x + x * x2 *
                         (splat(-1.0f / 6) +
                          x2 * (splat(1.0f / 120) + x2 * (splat(-1.0f / 5040) + x2 * splat(1.0f / 362880))));
  const Lane c =
      splat(1) +
      x2 * (splat(-0.5f) + x2 * (splat(1.0f / 24) + x2 * (splat(-1.0f / 720) + x2 * splat(1.0f / 40320))));
  const LaneMask quarter = __builtin_convertvector(quarters, LaneMask) & 3;
  const LaneMask swapped = (quarter & 1) != 0;
  sine = select(swapped, c, s), cosine = select(swapped, s, c);
  sine = select(quarter >= 2, -sine, sine);
  cosine = select((quarter == 1) | (quarter == 2), -cosine, cosine);
}

// Arc sine for |x| ≤ 1, within 7e-5 (Abramowitz and Stegun 4.4.45).
inline Lane arc_sine(Lane x) {
  const Lane a = min(abs(x), splat(1));
  const Lane p =
      splat(1.5707288f) + a * (splat(-0.2121144f) + a * (splat(0.0742610f) - a * splat(0.0187293f)));
  const Lane r = splat(1.57079632679489662f) - sqrt(splat(1) - a) * p;
  return select(x < Lane{}, -r, r);
}

// Two uniform numbers in [0, 1) for each pair of keys, by rounds of multiplication and shifts.
typedef std::uint32_t LaneBits __attribute__((vector_size(64)));
inline LaneBits mix(LaneBits x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}
inline LaneBits mix_pair(LaneBits row, LaneBits column, std::uint32_t seed) {
  return mix(mix(row * 0x9e3779b9u ^ seed) ^ column);
}
inline Lane unit_lane(LaneBits x) {
  return __builtin_convertvector(reinterpret_cast<LaneMask>(x >> 8), Lane) * splat(0x1p-24f);
}

}  // namespace lumirank
