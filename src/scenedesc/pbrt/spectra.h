// From pbrt's spectra to linear Rec. 709 RGB.
//
// pbrt renders with spectra and integrates its film with the CIE 1931 observer such that a light of "rgb"
// (1, 1, 1) has the pixel value (1, 1, 1): lights are divided by the luminance of their own spectrum, an rgb
// color by that of its color space's white (DiffuseAreaLight, PointLight, … of pbrt-v4, lights.cpp). So every
// light given as a spectrum, a blackbody or a name has luminance 1 before its "scale", and only its
// chromaticity counts.
#pragma once

#include <optional>
#include <string>

#include "base/rgb.h"
#include "base/spectrum.h"
#include "scenedesc/pbrt/params.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc::pbrt {

enum class ColorSpace { srgb, dci_p3, rec2020, aces };
std::optional<ColorSpace> color_space(const std::string& name);

enum class Intent {
  albedo,      // between 0 and 1
  unbounded,   // 0 or more: indices of refraction, absorption
  illuminant,  // of luminance 1 unless it is an rgb color
};
// `rgb` in that space as Rec. 709; whites stay white for albedos, and keep their own color for lights.
Rgb from_space(Rgb rgb, ColorSpace space, Intent intent);

// A parameter of type rgb, spectrum or blackbody; empty if it is not there or is a texture. Numbers out of
// the intent's range are an InputError.
std::optional<Rgb> constant_color(Params& p, const char* name, Intent intent);

// The index of a dielectric: a number, a named glass, or a spectrum (its value at 587.6 nm, with a warning).
float dielectric_eta(Params& p, const char* name, float fallback);

struct ConductorIndex {
  Rgb eta, k;
};
// From "eta" and "k" (with a prefix), copper by default. Spectra become the RGB indices whose reflectance at
// normal incidence is that of the spectra under D65.
ConductorIndex conductor_index(Params& p, const char* eta, const char* k);

// Nanometers and values from a text file of pairs.
SampledSpectrum spectrum_file(Params& p, const char* name, const std::string& file);

}  // namespace lumirank::scenedesc::pbrt
