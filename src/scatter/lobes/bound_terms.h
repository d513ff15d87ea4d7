// Parts of the bounds of lobes: ranges of angles, and terms that families share. Inside this room only.
#pragma once

#include <algorithm>
#include <cmath>

#include "scatter/lobe_bound.h"

namespace lumirank::scatter {

// What is known of all w at hand: cosines with n on the lobe's side, the tilt of the half vector from n (its
// least by sine and cosine, the sine of its greatest), the least cosine of half the angle between wo and w,
// the greatest cosine with the mirror direction of wo.
struct AngleRange {
  float cos_lo = 0, cos_hi = 1;
  float tilt_sin = 0, tilt_cos = 1, max_tilt_sin = 1;
  float half_lo = 0;
  float cos_mirror = 1;
};

// Slack of angles worked out in floats, in radians.
inline constexpr float kAngleSlack = 2e-6f;

// Sums of angles are worked out by their sines and cosines, whose roundings the slack covers.
struct Angle {
  float sine, cosine;
  static Angle of(float radians) { return {std::sin(radians), std::cos(radians)}; }
  static Angle of_cosine(float cosine) {
    const float c = std::clamp(cosine, -1.0f, 1.0f);
    return {std::sqrt(1 - c * c), c};
  }
};
// The width of a cone, as sines and cosines where it is less than a half turn.
struct ConeWidth {
  float angle;
  Angle whole{0, -1}, half{1, 0};
  explicit ConeWidth(float radians) : angle(radians) {
    if (radians >= kPi) return;
    half = Angle::of(0.5f * radians);
    whole = {2 * half.sine * half.cosine, 1 - 2 * half.sine * half.sine};
  }
};

// eval_f() answers above it.
inline constexpr float kMinCosine = 1e-6f;

// Of a fiber: the greatest sine of the angle to it between two latitudes (radians).
inline float max_sine_of(float lo, float hi) {
  return lo <= 0 && hi >= 0 ? 1.0f : std::max(std::cos(lo), std::cos(hi));
}

// exp(-tan²/α²)/cos⁴ over all tilts.
float gaussian_slopes(const AngleRange& range, float alpha);
// G1 of a round distribution.
float masking(NormalDistribution distribution, float cosine, float alpha);

}  // namespace lumirank::scatter
