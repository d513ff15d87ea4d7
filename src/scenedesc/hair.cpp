#include "scenedesc/hair.h"

#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace lumirank::scenedesc {
namespace {

// Unpolarised reflectance of a dielectric of relative index eta > 0 at cosine c.
double fresnel(double c, double eta) {
  const double s2 = (1 - c * c) / (eta * eta);
  if (s2 >= 1) return 1;
  const double t = std::sqrt(1 - s2);
  const double p = (eta * c - t) / (eta * c + t), s = (c - eta * t) / (c + eta * t);
  return 0.5 * (p * p + s * s);
}

}  // namespace

Rgb hair_absorption(float eumelanin, float pheomelanin) {
  return Rgb(0.419f, 0.697f, 1.37f) * eumelanin + Rgb(0.187f, 0.4f, 1.05f) * pheomelanin;
}

HairDesc hair_from_absorption(Rgb sigma_a, float eta, float beta_m) {
  // Over the width of the fibre, h from -1 to 1: F is reflected at once; (1 - F)² T (1 + FT + F²T² + …)
  // leaves after 1, 2, 3, … passages, T being the transmittance of one.
  constexpr int kSteps = 256;
  double reflected = 0, inside[3] = {0, 0, 0};
  for (int k = 0; k < kSteps; ++k) {
    const double h = (k + 0.5) / kSteps;
    const double f = fresnel(std::sqrt(1 - h * h), eta),
                 chord = 2 * std::sqrt(std::max(0.0, 1 - h * h / (eta * eta)));
    reflected += f / kSteps;
    for (int c = 0; c < 3; ++c) {
      const double t = std::exp(-static_cast<double>(sigma_a[c]) * chord);
      inside[c] += f < 1 ? (1 - f) * (1 - f) * t / (1 - f * t) / kSteps : 0;
    }
  }
  HairDesc out;
  out.specular_reflectance.value = Rgb(static_cast<float>(reflected));
  for (int c = 0; c < 3; ++c) out.diffuse_reflectance.value[c] = static_cast<float>(inside[c]);
  // The variance of the longitudinal lobe (Chiang et al. 2016, equation 7); cosⁿ has about 1/n.
  const float b = std::clamp(beta_m, 0.0f, 1.0f);
  const float variance = square(0.726f * b + 0.812f * b * b + 3.7f * std::pow(b, 20.0f));
  out.exponent.value = std::clamp(1 / std::max(variance, 1e-5f), 1.0f, 1e4f);
  return out;
}

}  // namespace lumirank::scenedesc
