// The coating of plastic: how much light a (smooth or rough) dielectric interface lets through, prepared so
// that the evaluation at a pair of directions needs nothing but their cosines.
#pragma once

#include "scatter/closure.h"
#include "scatter/fresnel.h"

namespace lumirank::scatter {

// T(μ) of LobeKind::interfaced_diffuse: c0 + c1·s + c2·s² + c3·s³ + c4·μ + c5·μ², s = 1 - F(μ, eta) being the
// smooth interface's transmittance, held within [0, 1]. A smooth coating has c1 = 1 and all others 0. The
// coefficients lie in conductor_eta (c0, c1, c2) and conductor_k (c3, c4, c5).
inline float interface_transmittance(const Lobe& lobe, float cos_theta) {
  const float s = 1 - fresnel_dielectric(cos_theta, lobe.eta);
  const Rgb a = lobe.conductor_eta, b = lobe.conductor_k;
  const float p = a.r + s * (a.g + s * (a.b + s * b.r)) + cos_theta * (b.g + cos_theta * b.b);
  return std::clamp(p, 0.0f, 1.0f);
}

// The numbers of one interface. Rough ones: integrals of single scattering by the microfacet distribution
// (masked light is lost, as in Mitsuba), tabulated once per distribution over roughness and index and
// interpolated.
struct InterfaceCoefficients {
  float c[6] = {0, 1, 0, 0, 0, 0};
  // The same for light that passes twice without losing its direction, as under a coat (coat.h): the
  // geometric mean of T(μ) and of what gets out again at the refracted angle.
  float twice[6] = {0, 1, 0, 0, 0, 0};
  // What the layer's reflection leaves, 1 - R(μ) from outside: T(μ) and the light that masking loses.
  float left[6] = {0, 1, 0, 0, 0, 0};
  float diffuse_transmittance = 1;  // 2∫T(μ)μ dμ, from outside
  float diffuse_left = 1;           // 2∫(1 - R(μ))μ dμ, from outside
  float internal_reflectance = 0;   // 2∫R(μ)μ dμ, from inside
};
// alpha = 0: smooth. Thread-safe; the same numbers whoever asks first.
InterfaceCoefficients interface_coefficients(NormalDistribution distribution, float alpha, float eta);

// Plastic's base: color/π·T(wi)·T(wo)/(eta²·(1 - r)), r the internal reflectance, times the color if
// nonlinear. All that does not depend on directions is folded into the lobe's color.
// Of a rough interface, `as_mitsuba_3` takes r as Mitsuba 3 does: the mean of 2 R(μ) μ over 64 cosines from 0
// to 1 with both ends, which is 63/64 of the trapezoidal rule's integral and R(1)/64.
Lobe interfaced_diffuse_lobe(Rgb color, float eta, NormalDistribution distribution, float alpha,
                             bool nonlinear, bool as_mitsuba_3 = false);
// A base that gets all that the layer does not reflect: color/π·L(wi)·L(wo)/(2∫L(μ)μ dμ), L = 1 - R. With the
// layer's reflection it sends back all light if it is white (Kelemen and Szirmay-Kalos 2001).
Lobe lossless_diffuse_lobe(Rgb color, float eta, NormalDistribution distribution, float alpha);
// What a metal's microfacets lose by masking each other, sent back by further bounces: color/π·L(wi)·L(wo) /
// (2∫L(μ)μ dμ), L = 1 - E, E the albedo of white ones. Each bounce is colored by the mean Fresnel factor of
// Schlick's curve from `f0`. Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks"; black
// where less than half a percent is lost.
Lobe masked_reflection_lobe(Rgb f0, NormalDistribution distribution, float alpha);

}  // namespace lumirank::scatter
