// The sun by daylight: A. J. Preetham, P. Shirley, B. Smits, "A Practical Analytic Model for Daylight",
// SIGGRAPH 1999. The sky is in hosek_wilkie.h.
//
// Units: linear Rec. 709 RGB of spectral radiance averaged with the luminosity curve, in W·m⁻²·sr⁻¹·nm⁻¹, the
// units of Mitsuba's sun and sky. So a luminance of 683 × 106.857 cd/m² has a luminance() of 1 here (683
// lm/W; 106.857 nm is the integral of the CIE 1931 ȳ curve).
//
// Mitsuba 0.6's sun is this same model, integrated over a finer table.
#pragma once

#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::emitters {

// Mean radiance of the sun's disc at the ground (appendix A.1 of the paper: extinction by Rayleigh and
// aerosol scattering, ozone, mixed gases and water vapor), for a sun at the zenith angle `theta` (radians,
// below π/2).
Rgb sun_radiance(float turbidity, float theta);

// Half of the sun's apparent diameter of 0.5358°, as in Mitsuba.
inline constexpr float kSunHalfAngle = 0.5f * 0.5358f * kPi / 180;

}  // namespace lumirank::emitters
