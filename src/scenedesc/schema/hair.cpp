#include "scenedesc/schema/hair.h"

#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace lumirank::scenedesc {
namespace {

// Unpolarized reflectance of a dielectric of relative index eta > 0 at cosine c.
double fresnel(double c, double eta) {
  const double s2 = (1 - c * c) / (eta * eta);
  if (s2 >= 1) return 1;
  const double t = std::sqrt(1 - s2);
  const double p = (eta * c - t) / (eta * c + t), s = (c - eta * t) / (c + eta * t);
  return 0.5 * (p * p + s * s);
}

// Of light across the fiber, over its width, h from -1 to 1: F is reflected at once; (1 - F)² T (1 + FT +
// F²T²
// + …) leaves after 1, 2, 3, … passages, T being the transmittance of one.
struct Shares {
  double reflected = 0, inside = 0;
};
Shares shares(double sigma, double eta) {
  constexpr int kSteps = 256;
  Shares out;
  for (int k = 0; k < kSteps; ++k) {
    const double h = (k + 0.5) / kSteps;
    const double f = fresnel(std::sqrt(1 - h * h), eta),
                 t = std::exp(-sigma * 2 * std::sqrt(std::max(0.0, 1 - h * h / (eta * eta))));
    out.reflected += f / kSteps;
    out.inside += f < 1 ? (1 - f) * (1 - f) * t / (1 - f * t) / kSteps : 0;
  }
  return out;
}

// The standard deviation of the longitudinal lobe (Chiang et al. 2016, equation 7).
float lobe_width(float b) { return 0.726f * b + 0.812f * b * b + 3.7f * std::pow(b, 20.0f); }

// Where a rising function reaches `value`, or the nearer end.
template <typename F>
double solve(F&& f, double value, double lo, double hi) {
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (lo + hi);
    (f(middle) < value ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
}

}  // namespace

Rgb hair_absorption(float eumelanin, float pheomelanin) {
  return Rgb(0.419f, 0.697f, 1.37f) * eumelanin + Rgb(0.187f, 0.4f, 1.05f) * pheomelanin;
}

HairDesc hair_from_absorption(Rgb sigma_a, float eta, float beta_m) {
  HairDesc out;
  out.specular_reflectance.value = Rgb(static_cast<float>(shares(0, eta).reflected));
  for (int c = 0; c < 3; ++c)
    out.diffuse_reflectance.value[c] =
        static_cast<float>(shares(static_cast<double>(sigma_a[c]), eta).inside);
  // cosⁿ has about the variance 1/n.
  const float variance = square(lobe_width(std::clamp(beta_m, 0.0f, 1.0f)));
  out.exponent.value = std::clamp(1 / std::max(variance, 1e-5f), 1.0f, 1e4f);
  return out;
}

HairAbsorption hair_to_absorption(const HairDesc& hair) {
  HairAbsorption out;
  const auto specular = static_cast<double>(mean(hair.specular_reflectance.value));
  const double eta = solve([](double x) { return shares(0, x).reflected; }, specular, 1.0001, 10);
  out.eta = static_cast<float>(eta);
  for (int c = 0; c < 3; ++c) {
    const auto diffuse = static_cast<double>(hair.diffuse_reflectance.value[c]);
    out.sigma_a[c] = static_cast<float>(
        solve([eta](double x) { return -shares(x, static_cast<float>(eta)).inside; }, -diffuse, 0, 50));
  }
  const double width = 1 / std::sqrt(std::max(1.0, static_cast<double>(hair.exponent.value)));
  out.beta_m = static_cast<float>(
      solve([](double b) { return static_cast<double>(lobe_width(static_cast<float>(b))); }, width, 0, 1));
  return out;
}

}  // namespace lumirank::scenedesc
