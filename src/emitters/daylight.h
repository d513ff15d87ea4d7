// Clear-sky daylight: A. J. Preetham, P. Shirley, B. Smits, "A Practical Analytic Model for Daylight",
// SIGGRAPH 1999.
//
// Units: linear Rec. 709 RGB of spectral radiance averaged with the luminosity curve, in W·m⁻²·sr⁻¹·nm⁻¹, the
// units of Mitsuba's sun and sky. So a luminance of 683 × 106.857 cd/m² has a luminance() of 1 here (683
// lm/W; 106.857 nm is the integral of the CIE 1931 ȳ curve).
//
// What differs from Mitsuba: its sun (0.6) is this same model of the sun, integrated over a finer table; its
// sky is the model of Hosek and Wilkie (2012), which knows the albedo of the ground, has a brighter and
// redder halo around a low sun and stays plausible at high turbidity. Here the ground's albedo has no
// influence.
#pragma once

#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::emitters {

class PreethamSky {
 public:
  // `to_sun` is a unit vector with +y up, above the horizon. The fits of the paper hold for turbidities 2 to
  // about 6; below 1.7 the zenith's luminance turns negative, so the caller clamps to kMinTurbidity.
  static constexpr float kMinTurbidity = 1.7f, kMaxTurbidity = 10;
  PreethamSky(float turbidity, Vec3f to_sun);

  // Radiance from a unit direction (+y up); black below the horizon.
  Rgb radiance(Vec3f direction) const;

 private:
  struct Perez {
    double a, b, c, d, e;
    double eval(double cos_theta, double gamma) const;
  };
  Vec3f to_sun_;
  Perez Y_, x_, y_;
  double zenith_Y_, zenith_x_,
      zenith_y_;  // kcd/m² and chromaticities, divided by the Perez value of the zenith
};

// Mean radiance of the sun's disc at the ground (appendix A.1 of the paper: extinction by Rayleigh and
// aerosol scattering, ozone, mixed gases and water vapor), for a sun at the zenith angle `theta` (radians,
// below π/2).
Rgb sun_radiance(float turbidity, float theta);

// Half of the sun's apparent diameter of 0.5358°, as in Mitsuba.
inline constexpr float kSunHalfAngle = 0.5f * 0.5358f * kPi / 180;

}  // namespace lumirank::emitters
