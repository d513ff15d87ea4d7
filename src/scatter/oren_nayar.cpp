// The full model of Oren and Nayar 1994 with its interreflection term (equation 27 and 28 there; Mitsuba's
// roughdiffuse without its fast approximation).
#include "scatter/lobe.h"

namespace lumirank::scatter {

// alpha_u is σ; color multiplies the direct part (∝ ρ), conductor_eta the interreflection (∝ ρ²).
Rgb oren_nayar_value(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  const float s2 = lobe.alpha_u * lobe.alpha_u;
  const float sin_o = std::sqrt(std::max(0.0f, 1 - wo.z * wo.z)),
              sin_i = std::sqrt(std::max(0.0f, 1 - wi.z * wi.z));
  const float sin_sin = sin_o * sin_i;
  const float cos_phi =
      sin_sin > 1e-12f ? std::clamp((wo.x * wi.x + wo.y * wi.y) / sin_sin, -1.0f, 1.0f) : 0.0f;
  const float theta_o = std::atan2(sin_o, wo.z), theta_i = std::atan2(sin_i, wi.z);
  const float alpha = std::max(theta_o, theta_i), beta = std::min(theta_o, theta_i);
  const float two_beta_pi = 2 * beta * kInvPi;
  const float c1 = 1 - 0.5f * s2 / (s2 + 0.33f);
  const float c2 = 0.45f * s2 / (s2 + 0.09f) *
                   (std::sin(alpha) - (cos_phi >= 0 ? 0.0f : two_beta_pi * two_beta_pi * two_beta_pi));
  const float c3 = 0.125f * s2 / (s2 + 0.09f) * square(4 * alpha * beta * kInvPi * kInvPi);
  const float direct =
      c1 + cos_phi * c2 * std::tan(beta) + (1 - std::abs(cos_phi)) * c3 * std::tan(0.5f * (alpha + beta));
  const float indirect = 0.17f * s2 / (s2 + 0.13f) * (1 - cos_phi * square(two_beta_pi));
  return (lobe.color * std::max(0.0f, direct) + lobe.conductor_eta * indirect) * kInvPi;
}

}  // namespace lumirank::scatter
