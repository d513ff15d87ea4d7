#include "scatter/interface.h"

#include "scatter/interface_table.h"

namespace lumirank::scatter {

InterfaceCoefficients interface_coefficients(NormalDistribution distribution, float alpha, float eta) {
  if (alpha > 0) return interface_table(distribution).lookup(alpha, eta);
  InterfaceCoefficients smooth;
  smooth.diffuse_transmittance = 1 - fresnel_diffuse_reflectance(eta);
  smooth.diffuse_left = smooth.diffuse_transmittance;
  smooth.internal_reflectance = fresnel_diffuse_reflectance(1 / eta);
  return smooth;
}

namespace {

// Of color 1, with the terms of its transmittance and their mean over diffuse light.
Lobe lobe_of_terms(NormalDistribution distribution, float alpha, float eta, const float (&terms)[6],
                   float mean) {
  Lobe lobe;
  lobe.kind = LobeKind::interfaced_diffuse;
  lobe.distribution = distribution;
  lobe.alpha_u = alpha;
  lobe.alpha_v = mean;
  lobe.eta = eta;
  lobe.conductor_eta = {terms[0], terms[1], terms[2]};
  lobe.conductor_k = {terms[3], terms[4], terms[5]};
  lobe.color = Rgb(1);
  return lobe;
}

}  // namespace

Lobe interfaced_diffuse_lobe(Rgb color, float eta, NormalDistribution distribution, float alpha,
                             bool nonlinear, bool as_mitsuba_3) {
  const InterfaceCoefficients k = interface_coefficients(distribution, alpha, eta);
  const float returned = as_mitsuba_3 && alpha > 0
                             ? (63 * k.internal_reflectance + fresnel_dielectric(1, 1 / eta)) / 64
                             : k.internal_reflectance;
  Lobe lobe = lobe_of_terms(distribution, alpha, eta, k.c, k.diffuse_transmittance);
  const Rgb trapped = nonlinear ? color * returned : Rgb(returned);
  lobe.color = color / ((Rgb(1) - trapped) * (eta * eta));
  return lobe;
}

Lobe lossless_diffuse_lobe(Rgb color, float eta, NormalDistribution distribution, float alpha) {
  const InterfaceCoefficients k = interface_coefficients(distribution, alpha, eta);
  Lobe lobe = lobe_of_terms(distribution, alpha, eta, k.left, k.diffuse_left);
  lobe.color = color / k.diffuse_left;
  return lobe;
}
Lobe masked_reflection_lobe(Rgb f0, NormalDistribution distribution, float alpha) {
  const MaskedCoefficients k = interface_table(distribution).masked(alpha);
  Lobe lobe = lobe_of_terms(distribution, alpha, kMaskedEta, k.left, k.diffuse_left);
  if (k.diffuse_left < 0.005f) {
    lobe.color = Rgb(0);
    return lobe;
  }
  const Rgb fresnel = f0 + (Rgb(1) - f0) / 21.0f;
  for (int c = 0; c < 3; ++c) {
    const float f = fresnel[c], kept = 1 - k.diffuse_left;
    lobe.color[c] = f * f * kept / (1 - f * k.diffuse_left) / k.diffuse_left;
  }
  return lobe;
}

}  // namespace lumirank::scatter
