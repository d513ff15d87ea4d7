// Tables of the sky and the sun of Hosek and Wilkie; see hosek_wilkie.h.
#pragma once

namespace lumirank::emitters {

// Turbidities 1 to 10, albedos of the ground 0 and 1, control points over the sun's elevation, RGB.
inline constexpr int kSkyTurbidities = 10, kSkyAlbedos = 2, kSkyElevations = 6, kSkyShape = 9;
extern const float kHosekWilkieShape[kSkyTurbidities * kSkyAlbedos * kSkyElevations * 3 * kSkyShape];
extern const float kHosekWilkieRadiance[kSkyTurbidities * kSkyAlbedos * kSkyElevations * 3];

// Turbidities 1 to 10; elevations π/2·(k/45)³ for k = 0 … 45; RGB.
inline constexpr int kSunElevations = 46;
extern const float kHosekWilkieSun[kSkyTurbidities * kSunElevations * 3];

}  // namespace lumirank::emitters
