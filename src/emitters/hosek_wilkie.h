// The clear sky: L. Hosek, A. Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance", SIGGRAPH 2012,
// the sky of Mitsuba 0.6 and 3. It knows the albedo of the ground, which lights the air from below. And the
// sun in it: the same, "Adding a Solar-Radiance Function to the Hošek-Wilkie Skylight Model", CG&A 2013, that
// of Mitsuba 3.
//
// Units: as of daylight.h.
#pragma once

#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::emitters {

class HosekWilkieSky {
 public:
  static constexpr float kMinTurbidity = 1, kMaxTurbidity = 10;
  // `to_sun`: unit, +y up, above the horizon. `albedo` in [0, 1].
  HosekWilkieSky(float turbidity, Rgb albedo, Vec3f to_sun);

  // Radiance from a unit direction (+y up); black below the horizon.
  Rgb radiance(Vec3f direction) const;

 private:
  // Of a channel: nine numbers of equation 8, and what its value is multiplied with.
  struct Channel {
    double shape[9];
    double radiance;
    double at(double cos_theta, double gamma) const;
  };
  Vec3f to_sun_;
  Channel channels_[3];
};

// Mean radiance of the sun's disc at an elevation in (0, π/2].
Rgb hosek_wilkie_sun(float turbidity, float elevation);

}  // namespace lumirank::emitters
