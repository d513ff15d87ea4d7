// Spectra of lights, glasses and metals by the names that pbrt has for them.
#pragma once

#include <optional>
#include <string>

#include "base/rgb.h"
#include "base/spectrum.h"

namespace lumirank::scenedesc {

// Linear Rec. 709 of a chromaticity of the CIE 1931 observer, at luminance 1.
Rgb from_chromaticity(double x, double y);

std::optional<Rgb> named_illuminant(const std::string& name);         // luminance 1
std::optional<float> named_glass(const std::string& name);            // "glass-BK7", at 587.6 nm
std::optional<SampledSpectrum> named_metal(const std::string& name);  // "metal-Cu-eta", "metal-Cu-k"

}  // namespace lumirank::scenedesc
