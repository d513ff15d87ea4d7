// Microfacet distributions: the normal distribution D, Smith's masking G1, and sampling of visible normals.
// Walter et al. 2007 (Beckmann and GGX), Heitz 2014 (anisotropic Smith masking).
//
// Everything is in the local frame (z is the normal). D and G1 are inline, branch-free and without library
// tables, so that the vectorized kernels can be written after them line by line.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"
#include "scatter/closure.h"

namespace lumirank::scatter {

// Smallest roughness of a rough lobe; smoother ones would need more digits than a float has.
inline constexpr float kMinAlpha = 1e-4f;

inline float ggx_d(Vec3f m, float alpha_u, float alpha_v) {
  const float x = m.x / alpha_u, y = m.y / alpha_v, d = x * x + y * y + m.z * m.z;
  return kInvPi / (alpha_u * alpha_v * d * d);
}

// For z > 0. 2/(1 + √(1 + α²tan²)).
inline float ggx_g1(Vec3f v, float alpha_u, float alpha_v) {
  const float x = v.x * alpha_u, y = v.y * alpha_v, z = std::abs(v.z);
  return 2 * z / (z + std::sqrt(z * z + x * x + y * y));
}

inline float beckmann_d(Vec3f m, float alpha_u, float alpha_v) {
  const float x = m.x / alpha_u, y = m.y / alpha_v, z2 = std::max(m.z * m.z, 1e-12f);
  return kInvPi * std::exp(-(x * x + y * y) / z2) / (alpha_u * alpha_v * z2 * z2);
}

// Smith's Λ of the Beckmann distribution: (exp(-a²)/(a√π) - erfc(a))/2 with a = cot/α. erfc by the rational
// form of Abramowitz and Stegun 7.1.26, good to 1.5e-7, which shares the exponential.
inline float beckmann_lambda(float a) {
  const float t = 1 / (1 + 0.3275911f * a);
  const float poly =
      t * (0.254829592f + t * (-0.284496736f + t * (1.421413741f + t * (-1.453152027f + t * 1.061405429f))));
  return std::max(0.0f, 0.5f * std::exp(-a * a) * (0.5641895835f / a - poly));
}

inline float beckmann_g1(Vec3f v, float alpha_u, float alpha_v) {
  const float x = v.x * alpha_u, y = v.y * alpha_v;
  const float a = std::abs(v.z) / std::sqrt(std::max(x * x + y * y, 1e-20f));
  return 1 / (1 + beckmann_lambda(std::max(a, 1e-12f)));
}

inline float microfacet_d(NormalDistribution kind, Vec3f m, float alpha_u, float alpha_v) {
  return kind == NormalDistribution::ggx ? ggx_d(m, alpha_u, alpha_v) : beckmann_d(m, alpha_u, alpha_v);
}
inline float microfacet_g1(NormalDistribution kind, Vec3f v, float alpha_u, float alpha_v) {
  return kind == NormalDistribution::ggx ? ggx_g1(v, alpha_u, alpha_v) : beckmann_g1(v, alpha_u, alpha_v);
}

// Density, per solid angle of m, of the normals that are visible from `w` (w.z > 0): G1(w)·max(0,
// w·m)·D(m)/w.z.
inline float visible_normal_pdf(NormalDistribution kind, Vec3f w, Vec3f m, float alpha_u, float alpha_v) {
  return microfacet_g1(kind, w, alpha_u, alpha_v) * std::max(0.0f, dot(w, m)) *
         microfacet_d(kind, m, alpha_u, alpha_v) / w.z;
}

// Draws such a normal; w.z > 0. GGX: Dupuy and Benyoub 2023 (spherical caps). Beckmann: inversion of the
// distribution of visible slopes (Heitz and d'Eon 2014), by safeguarded Newton steps.
Vec3f sample_visible_normal(NormalDistribution kind, Vec3f w, Vec2f u, float alpha_u, float alpha_v);

}  // namespace lumirank::scatter
