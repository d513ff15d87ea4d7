// Participating media by name.
#pragma once

#include <optional>
#include <string>

#include "base/rgb.h"

namespace lumirank::scenedesc {

// Coefficients for each millimeter, and the mean cosine of a Henyey-Greenstein phase function.
struct NamedMedium {
  Rgb scattering, absorption, mean_cosine;
};

// drink, jade, soap, juice, skin and milk, as Huo et al. 2016 have them (table 1, from Gkioulekas et al. 2013
// and Jakob 2010). The table states no unit; millimeters are what its sources use. Its absorption of juice
// and of skin is the same to the digit, so one of the two is likely a slip: both are given as printed.
// Apple to Wholemilk, in pbrt's spelling: Jensen et al. 2001 ("A Practical Model for Subsurface Light
// Transport", table 2), whose scattering is reduced, so that it is the same in all directions.
std::optional<NamedMedium> named_medium(const std::string& name);
std::string medium_names();

// What a half space of a medium sends back of diffuse light, without a boundary that reflects: van de Hulst's
// fit (1980, "Multiple Light Scattering", section 14.3), within 0.01. `mean_cosine` below 1.
Rgb albedo_of_depth(Rgb scattering, Rgb absorption, float mean_cosine);

}  // namespace lumirank::scenedesc
