// Bounds of single lobes over ranges of angles. Inside this room only.
#pragma once

#include "scatter/lobe_bound.h"

namespace lumirank::scatter {

// What is known of all w at hand: cosines with n on the lobe's side, the angle between n and the half vector,
// the cosine of half the angle between wo and w, the angle between w and the mirror direction of wo.
struct AngleRange {
  float cos_lo = 0, cos_hi = 1;
  float tilt_lo = 0, tilt_hi = kPi / 2;
  float half_lo = 0;  // cosine
  float off_mirror = 0;
};

// Slack of angles worked out in floats, in radians.
inline constexpr float kAngleSlack = 2e-6f;

bool needs_cosine_only(LobeKind kind);
// The part of f that depends on wo alone, without the colour.
float factor_of_wo(const Lobe& lobe, float cos_o, float narrowest);
// At least scale · f / factor_of_wo, times the cosine if asked for. microfacet_transmit: without the
// Jacobian's denominator.
Rgb term_bound(const LobeTerm& term, const AngleRange& range, Slant slant);
// Of a lobe of a fibre, at all w whose latitudes (radians) lie between the two.
Rgb fibre_term_bound(const LobeTerm& term, float latitude_o, float latitude_lo, float latitude_hi,
                     Slant slant);

}  // namespace lumirank::scatter
