#include "scenedesc/mitsuba/solar.h"

#include <cmath>

namespace lumirank::scenedesc::mitsuba {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

// Julian day number of noon UTC of a date of the Gregorian calendar.
long julian_day(int year, int month, int day) {
  const long a = (14 - month) / 12, y = year + 4800L - a, m = month + 12 * a - 3;
  return day + (153 * m + 2) / 5 + 365 * y + y / 4 - y / 100 + y / 400 - 32045;
}

}  // namespace

SunPosition sun_position(const PlaceAndTime& when) {
  const double hours = when.hour - when.timezone + when.minute / 60 + when.second / 3600;
  // Days since the epoch J2000.0 (noon of 2000-01-01).
  const double n =
      static_cast<double>(julian_day(when.year, when.month, when.day) - 2451545L) + (hours - 12) / 24;
  const double mean_longitude = 280.460 + 0.9856474 * n;
  const double anomaly = (357.528 + 0.9856003 * n) * kDegree;
  const double ecliptic =
      (mean_longitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * kDegree;
  const double obliquity = (23.439 - 0.0000004 * n) * kDegree;
  const double right_ascension = std::atan2(std::cos(obliquity) * std::sin(ecliptic), std::cos(ecliptic));
  const double declination = std::asin(std::sin(obliquity) * std::sin(ecliptic));
  // Greenwich mean sidereal time in degrees, then the hour angle, positive after noon.
  const double sidereal = 280.46062 + 360.98564737 * n;
  const double hour_angle = (sidereal + when.longitude) * kDegree - right_ascension;
  const double latitude = when.latitude * kDegree;
  SunPosition out;
  out.elevation = std::asin(std::sin(latitude) * std::sin(declination) +
                            std::cos(latitude) * std::cos(declination) * std::cos(hour_angle));
  out.azimuth = std::atan2(-std::sin(hour_angle) * std::cos(declination),
                           std::cos(latitude) * std::sin(declination) -
                               std::sin(latitude) * std::cos(declination) * std::cos(hour_angle));
  return out;
}

Vec3f sun_direction(const SunPosition& p) {
  return {static_cast<float>(std::sin(p.azimuth) * std::cos(p.elevation)),
          static_cast<float>(std::sin(p.elevation)),
          static_cast<float>(-std::cos(p.azimuth) * std::cos(p.elevation))};
}

}  // namespace lumirank::scenedesc::mitsuba
