// Indices of refraction by name.
#pragma once

#include <optional>
#include <string>

#include "base/rgb.h"
#include "base/spectrum.h"

namespace lumirank::scenedesc {

// The names of Mitsuba's list: "bk7", "water", "air", …; case does not matter.
std::optional<float> dielectric_index(const std::string& name);
std::string dielectric_names();

struct MetalIndex {
  Rgb eta, k;
};
// Measured n and k of a metal by its symbol, integrated as Mitsuba's RGB modes do it (as an emission
// spectrum, so that the values are those that its users know).
std::optional<MetalIndex> metal_index(const std::string& name);
std::string metal_names();
// The measurements themselves.
struct MetalSpectra {
  SampledSpectrum n, k;
};
std::optional<MetalSpectra> metal_spectra(const std::string& name);

}  // namespace lumirank::scenedesc
