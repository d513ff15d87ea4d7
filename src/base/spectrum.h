// From spectra to linear Rec. 709 RGB through the CIE 1931 2° observer.
// Two integrals, as Mitsuba does it in its RGB modes:
//  * emission: ∫ L(λ) x̄ dλ / ∫ ȳ dλ. A spectrum of constant value c has luminance c but is faintly red, since
//    equal-energy light is not the white of Rec. 709 (D65): c·(1.205, 0.948, 0.909).
//  * reflectance: the same of R(λ) under D65, so that a constant reflectance c is the gray (c, c, c).
#pragma once

#include <string>
#include <vector>

#include "base/rgb.h"

namespace lumirank {

// Piecewise linear between its samples, 0 outside them. Wavelengths in nm, strictly increasing.
struct SampledSpectrum {
  std::vector<float> wavelengths, values;
  float at(float wavelength) const;
};

Rgb emission_to_rgb(const SampledSpectrum& spectrum);
// Also for indices of refraction given as spectra.
Rgb reflectance_to_rgb(const SampledSpectrum& spectrum);

// Planck's law at `kelvin` in W m⁻² sr⁻¹ nm⁻¹, through `emission_to_rgb`. kelvin > 0.
Rgb blackbody_to_rgb(float kelvin);
// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹.
double planck(double wavelength_nm, double kelvin);

// The sRGB decoding curve (IEC 61966-2-1), channel by channel.
Rgb srgb_to_linear(Rgb encoded);

}  // namespace lumirank
