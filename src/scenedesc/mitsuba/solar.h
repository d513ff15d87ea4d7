// Position of the sun.
#pragma once

#include "base/vec.h"

namespace lumirank::scenedesc::mitsuba {

struct PlaceAndTime {
  double latitude = 35.6894, longitude = 139.6917;  // degrees, north and east positive
  double timezone = 9;                              // hours ahead of UTC
  int year = 2010, month = 7, day = 10;
  double hour = 15, minute = 0, second = 0;  // local time
};

struct SunPosition {
  double elevation;  // radians above the horizon
  double azimuth;    // radians from north towards east
};

// Low-precision formulas of the Astronomical Almanac: within about 0.01° from 1950 to 2050. No refraction.
SunPosition sun_position(const PlaceAndTime& when);

// Unit vector towards the sun in a frame of +x east, +y up, +z south (Mitsuba 0.6).
Vec3f sun_direction(const SunPosition& position);

}  // namespace lumirank::scenedesc::mitsuba
