// Fresnel reflectances of smooth interfaces, for unpolarized light. Inline and free of branches that a
// vectorized copy could not follow; see also fresnel.cpp for hemispherical means.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/rgb.h"

namespace lumirank::scatter {

// Dielectric. `cos_i` is the cosine on the side where the light comes from, in [0, 1]; `eta` is the index of
// the other side over that of this one. 1 under total internal reflection. `cos_t`, if given, receives the
// refracted cosine (0 under total internal reflection).
inline float fresnel_dielectric(float cos_i, float eta, float* cos_t_out = nullptr) {
  const float c = std::min(cos_i, 1.0f);
  const float cos_t2 = 1 - (1 - c * c) / (eta * eta);
  const float cos_t = std::sqrt(std::max(cos_t2, 0.0f));
  if (cos_t_out) *cos_t_out = cos_t;
  // The two polarizations; the tiny term keeps 0/0 away for eta = 1 at exactly grazing light.
  const float parallel = (eta * c - cos_t) / (eta * c + cos_t + 1e-20f);
  const float perpendicular = (c - eta * cos_t) / (c + eta * cos_t + 1e-20f);
  const float r = 0.5f * (parallel * parallel + perpendicular * perpendicular);
  return cos_t2 > 0 ? std::min(r, 1.0f) : 1.0f;
}

// What a dielectric transmits between two directions whose cosines are both known (each on its own side): 1 -
// F without its cancellation, and the same number from either side. `eta` as above.
inline float fresnel_transmittance(float cos_i, float cos_t, float eta) {
  const float perpendicular = cos_i + eta * cos_t, parallel = eta * cos_i + cos_t;
  return 2 * eta * cos_i * cos_t *
         (1 / (perpendicular * perpendicular + 1e-20f) + 1 / (parallel * parallel + 1e-20f));
}

// Conductor with complex index eta + i·k relative to the outside, exact for one wavelength.
inline float fresnel_conductor(float cos_i, float eta, float k) {
  const float c = std::min(cos_i, 1.0f), c2 = c * c, s2 = 1 - c2;
  const float t0 = eta * eta - k * k - s2;
  const float a2_plus_b2 = std::sqrt(t0 * t0 + 4 * eta * eta * k * k);
  const float a = std::sqrt(std::max(0.0f, 0.5f * (a2_plus_b2 + t0)));
  const float t1 = a2_plus_b2 + c2, t2 = 2 * a * c;
  const float perpendicular = (t1 - t2) / (t1 + t2 + 1e-20f);
  const float t3 = c2 * a2_plus_b2 + s2 * s2, t4 = t2 * s2;
  const float parallel = perpendicular * (t3 - t4) / (t3 + t4 + 1e-20f);
  return std::clamp(0.5f * (perpendicular + parallel), 0.0f, 1.0f);
}

inline Rgb fresnel_conductor(float cos_i, Rgb eta, Rgb k) {
  return {fresnel_conductor(cos_i, eta.r, k.r), fresnel_conductor(cos_i, eta.g, k.g),
          fresnel_conductor(cos_i, eta.b, k.b)};
}

// (1 - cos)⁵, Schlick's weight between normal and grazing reflectance.
inline float schlick_weight(float cos_i) {
  const float m = std::clamp(1 - cos_i, 0.0f, 1.0f), m2 = m * m;
  return m2 * m2 * m;
}

inline Rgb fresnel_schlick(float cos_i, Rgb f0) {
  const float w = schlick_weight(cos_i);
  return f0 + (Rgb(1) - f0) * w;
}

// Reflectance of a thin slab with all internal reflections, from that of one interface: 2R/(1 + R).
inline float fresnel_thin(float r) { return 2 * r / (1 + r); }
// That of a sheet that lets light pass unbent, or of one of its two faces, of which each has that of one
// interface: together, with all reflections between them, they are the slab.
inline float sheet_reflectance(bool whole, float r) { return whole ? fresnel_thin(r) : r; }

// Reflectance of the interface for diffuse light: 2∫F(μ)μ dμ. `eta` as in fresnel_dielectric(): light on the
// side with index 1, the other side has index eta. Closed form (Walsh 1926; as in Duntley 1942).
float fresnel_diffuse_reflectance(float eta);

}  // namespace lumirank::scatter
