// From radiometric numbers to photometric ones; see docs/conventions.md.
#pragma once

namespace lumirank {

inline constexpr double kLumensPerWatt = 683;           // at 555 nm, by the definition of the candela
inline constexpr double kLuminosityIntegral = 106.857;  // nm: the integral of the CIE 1931 ȳ curve

// RGB values are spectral quantities averaged with ȳ, in W/nm per area and solid angle, so that a flat
// spectrum of 1 is white of luminance() 1. That is ∫ȳ dλ = 106.857 W weighted with the eye's response:
inline constexpr double kLumensPerUnit = kLumensPerWatt * kLuminosityIntegral;

}  // namespace lumirank
