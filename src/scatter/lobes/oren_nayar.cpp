// The full model of Oren and Nayar 1994 with its interreflection term (equation 27 and 28 there; Mitsuba's
// roughdiffuse without its fast approximation).
#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {
namespace {

// alpha_u is σ; color multiplies the direct part (∝ ρ), conductor_eta the interreflection (∝ ρ²).
Rgb oren_nayar_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
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

// Of the direct and of the interreflected part.
void oren_nayar_parts(const LobeTerm& t, const AngleRange& r, CosineFactor factor, float& direct,
                      float& indirect) {
  const float s2 = square(t.lobe->alpha_u);
  const float c1 = 1 - 0.5f * s2 / (s2 + 0.33f), c2 = 0.45f * s2 / (s2 + 0.09f),
              c3 = 0.125f * s2 / (s2 + 0.09f);
  const float lo = std::max(r.cos_lo, kMinCosine);
  // β is the smaller angle: its tangent is at most either's.
  const float max_cosine = std::max(t.cos_o, lo),
              tan_beta = std::sqrt(std::max(0.0f, 1 - max_cosine * max_cosine)) / max_cosine;
  const float tan_half = 2 / (t.cos_o + r.cos_lo);
  const float cosine = factor == CosineFactor::cosine ? r.cos_hi : 1.0f;
  float across = c2 * tan_beta * cosine;
  if (factor == CosineFactor::cosine) across = std::min(across, c2);  // tan β·cos θi ≤ sin θi
  direct = c1 * cosine + std::max(across, c3 * tan_half * cosine);
  indirect = 0.17f * s2 / (s2 + 0.13f) * 2 * cosine;
}

Rgb oren_nayar_bound(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  float direct, indirect;
  oren_nayar_parts(t, r, factor, direct, indirect);
  return t.scale * direct + t.at_normal * indirect;
}
UnderCoat oren_nayar_under_coat(LobeView view) { return {UnderCoat::Sort::diffuse, view.lobe.color}; }

}  // namespace

constinit const LobeFamily oren_nayar_family{.value = oren_nayar_value,
                                             .bound = oren_nayar_bound,
                                             .bound_by_cosine = true,
                                             .under_coat = oren_nayar_under_coat,
                                             .matt = true,
                                             .two_colors = true,
                                             .lanes = LaneForm::oren_nayar};

}  // namespace lumirank::scatter
