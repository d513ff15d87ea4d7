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
std::optional<NamedMedium> named_medium(const std::string& name);
std::string medium_names();

}  // namespace lumirank::scenedesc
