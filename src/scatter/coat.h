// Effect of a dielectric layer over a material on the light that passes through it. The layer's own
// reflection is a lobe like any other; the nested lobes are seen through the layer:
//
//   f(wo, wi) = T(wo)·T(wi)·A(wo')·A(wi')/eta² · f_nested(wo', wi'),
//
// wo' and wi' being the directions refracted into the layer, T its transmittance from outside (rough layers:
// interface.h) and A = exp(-depth/cos') the absorption on the way. The factor 1/eta² is that of radiance
// which leaves the denser medium, so f is reciprocal where f_nested is. What the layer throws back inside is
// not in this formula: coating.cpp adds it.
#pragma once

#include <algorithm>
#include <cmath>

#include "scatter/closure.h"
#include "scatter/fresnel.h"

namespace lumirank::scatter {

inline float coat_transmittance(const Coat& coat, float cos_theta) {
  const float s = 1 - fresnel_dielectric(cos_theta, coat.eta);
  const float p = coat.t[0] + s * (coat.t[1] + s * (coat.t[2] + s * coat.t[3])) +
                  cos_theta * (coat.t[4] + cos_theta * coat.t[5]);
  return std::clamp(p, 0.0f, 1.0f);
}

// The cosine within the layer of a direction outside at `cos_theta`; 0 if it does not get in (eta < 1).
inline float coat_cosine(const Coat& coat, float cos_theta) {
  // So that near the horizon nothing is rounded away where directions are hardly bent.
  return std::sqrt(std::max(0.0f, cos_theta * cos_theta + (coat.bend * coat.bend - 1))) / coat.bend;
}

// A glossy lobe near the critical angle loses light to total internal reflection, of which most comes back to
// the same lobe after another bounce. The square of this factor, one for either direction, is what leaves in
// the end over what leaves at once: 1 + trapped·(1/p - 1) with p = (1 + x/√(1 + x²))/2, a smooth step in the
// distance x of the direction's cosine from the critical one in units of the lobe's width. A hundredth is
// taken off, so that far from the critical angle the factor is 1.
inline float coat_return(const Coat& coat, float inside) {
  const float critical = std::sqrt(std::max(0.0f, 1 - 1 / (coat.bend * coat.bend)));
  const float x = (inside - critical) / coat.width;
  const float y = std::sqrt(1 + x * x) - x;
  return std::sqrt(1 + coat.trapped * std::max(0.0f, y * y - 0.01f));
}

// T·A for one direction outside.
inline Rgb coat_passage(const Coat& coat, float cos_theta) {
  const float inside = coat_cosine(coat, cos_theta);
  if (!(inside > 0)) return Rgb(0);
  float t = coat_transmittance(coat, cos_theta);
  if (coat.trapped > 0) t *= coat_return(coat, inside);
  if (is_black(coat.depth)) return Rgb(t);
  const Rgb d = coat.depth;
  return Rgb(std::exp(-d.r / inside), std::exp(-d.g / inside), std::exp(-d.b / inside)) * t;
}

}  // namespace lumirank::scatter
