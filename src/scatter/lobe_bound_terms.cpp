#include "scatter/lobe_bound_terms.h"

#include <algorithm>
#include <cmath>

#include "scatter/charlie_sheen.h"
#include "scatter/fresnel.h"
#include "scatter/interface.h"
#include "scatter/lobe.h"
#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

constexpr float kLeastCosine = 1e-6f;  // eval_f() answers above it
constexpr float kClearcoatMask = 0.25f;

// exp(-tan²/α²)/cos⁴ over all tilts: it grows until 1/cos² = 2α².
float gaussian_slopes(const AngleRange& r, float alpha) {
  const float a2 = alpha * alpha;
  const float tan2 = std::max(square(r.tilt_sin / std::max(r.tilt_cos, 1e-6f)), 2 * a2 - 1);
  return std::exp(-tan2 / a2) * square(1 + tan2);
}

float normals(const LobeTerm& t, const AngleRange& r) {
  const float scale = kInvPi / (t.widest * t.narrowest);
  if (t.lobe->distribution == NormalDistribution::beckmann) return scale * gaussian_slopes(r, t.widest);
  float q = square(r.tilt_sin / t.widest) + square(r.tilt_cos);
  if (t.widest > 1) q = std::min(q, 1 / square(t.widest));
  return scale / (q * q);
}

float masking(NormalDistribution distribution, float cosine, float alpha) {
  const Vec3f v{std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine};
  return cosine > 0 ? microfacet_g1(distribution, v, alpha, alpha) : 0.0f;
}

// G1, or G1 over the cosine: bounded at grazing angles.
float masked(const LobeTerm& t, const AngleRange& r, Slant slant) {
  if (slant == Slant::cosine) return masking(t.lobe->distribution, r.cos_hi, t.narrowest);
  const float c = r.cos_lo, alpha = std::min(t.narrowest, 1.0f);
  if (t.lobe->distribution == NormalDistribution::ggx)
    return 2 / (c + std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c));
  // G1 = 1/(1 + Λ(a)) with a = cot/α, at most 1 and at most 2√π·a.
  const float grazing = std::sqrt(1 + square(3.54491f / alpha));
  return c > 0 ? std::min(1 / c, grazing) : grazing;
}

// Fresnel reflectances fall from right angles to the (pseudo) Brewster angle, if they do, and rise from
// there: the greatest is at one of the ends.
Rgb reflectance(const LobeTerm& t, const AngleRange& r) {
  if (t.lobe->fresnel == FresnelKind::none) return Rgb(1);
  const Rgb slanted = lobe_fresnel({*t.lobe, t.eta, true}, r.half_lo);
  return {std::max(t.at_normal.r, slanted.r), std::max(t.at_normal.g, slanted.g),
          std::max(t.at_normal.b, slanted.b)};
}

float ward(const LobeTerm& t, const AngleRange& r, Slant slant) {
  const float lo = std::max(r.cos_lo, kLeastCosine);
  if (t.lobe->variant == 2) {
    // |h|²·exp(-tan²/α²)/h_z⁴ = exp(-tan²/α²)/cos⁴ / |h|², |h| = 2·cos(d/2) and no less than h_z.
    const float len2 = std::max(square(2 * r.half_lo), square(t.cos_o + r.cos_lo));
    const float shape = gaussian_slopes(r, t.widest);
    if (slant == Slant::none) return shape / len2;
    return shape * std::min(r.cos_hi / len2, 1 / (4 * t.cos_o));  // c/(c_o + c)² has its peak at c_o
  }
  const float gaussian = std::exp(-square(r.tilt_sin / (std::max(r.tilt_cos, 1e-6f) * t.widest)));
  if (t.lobe->variant == 0)
    return gaussian * (slant == Slant::none ? 1 / std::sqrt(lo) : std::sqrt(r.cos_hi));
  return gaussian * (slant == Slant::none ? 1 / lo : 1.0f);
}

// Of the direct and of the interreflected part.
void oren_nayar(const LobeTerm& t, const AngleRange& r, Slant slant, float& direct, float& indirect) {
  const float s2 = square(t.lobe->alpha_u);
  const float c1 = 1 - 0.5f * s2 / (s2 + 0.33f), c2 = 0.45f * s2 / (s2 + 0.09f),
              c3 = 0.125f * s2 / (s2 + 0.09f);
  const float lo = std::max(r.cos_lo, kLeastCosine);
  // β is the smaller angle: its tangent is at most either's.
  const float most = std::max(t.cos_o, lo), tan_beta = std::sqrt(std::max(0.0f, 1 - most * most)) / most;
  const float tan_half = 2 / (t.cos_o + r.cos_lo);
  const float cosine = slant == Slant::cosine ? r.cos_hi : 1.0f;
  float across = c2 * tan_beta * cosine;
  if (slant == Slant::cosine) across = std::min(across, c2);  // tan β·cos θi ≤ sin θi
  direct = c1 * cosine + std::max(across, c3 * tan_half * cosine);
  indirect = 0.17f * s2 / (s2 + 0.13f) * 2 * cosine;
}

float disney_diffuse(const LobeTerm& t, const AngleRange& r, Slant slant) {
  const float fo = schlick_weight(t.cos_o), rr = 2 * t.lobe->alpha_u;
  // Linear in the weight of wi, so greatest at an end; it grows with rr.
  const auto smooth = [&](float fi) {
    return (1 - 0.5f * fo) * (1 - 0.5f * fi) + rr * (fo + fi + fo * fi * (rr - 1));
  };
  const float cosine = slant == Slant::cosine ? r.cos_hi : 1.0f;
  float most = std::max(smooth(schlick_weight(r.cos_lo)), smooth(schlick_weight(r.cos_hi))) * cosine;
  if (t.lobe->extra > 0) {
    // ss·(1/(co + ci) - 1/2) + 1/2, where ss ≤ 1 and the bracket is not negative.
    const float ss = square(std::max(1.0f, 0.5f * rr));
    const float flat = slant == Slant::cosine ? r.cos_hi / (t.cos_o + r.cos_hi) : 1 / (t.cos_o + r.cos_lo);
    most = lerp(most, 1.25f * ss * flat, t.lobe->extra);
  }
  return most;
}

}  // namespace

bool needs_cosine_only(LobeKind kind) {
  return kind == LobeKind::diffuse || kind == LobeKind::interfaced_diffuse ||
         kind == LobeKind::diffuse_transmit || kind == LobeKind::oren_nayar ||
         kind == LobeKind::disney_diffuse;
}

float factor_of_wo(const Lobe& lobe, float cos_o, float narrowest) {
  switch (lobe.kind) {
    case LobeKind::interfaced_diffuse:
      return kInvPi * interface_transmittance(lobe, cos_o);
    case LobeKind::microfacet_reflect:
    case LobeKind::thin_transmit:
      return masking(lobe.distribution, cos_o, narrowest) / (4 * cos_o);
    case LobeKind::microfacet_transmit:
      return masking(lobe.distribution, cos_o, narrowest) / cos_o;
    case LobeKind::phong:
      return (lobe.alpha_u + 2) * (0.5f * kInvPi);
    case LobeKind::ward: {
      const float area = kPi * lobe.alpha_u * lobe.alpha_v;
      return 1 / (area * (lobe.variant == 0 ? 4 * std::sqrt(cos_o) : lobe.variant == 1 ? 4 * cos_o : 1.0f));
    }
    case LobeKind::sheen:
      return 1;
    case LobeKind::charlie_sheen:
      // The albedo falls with the cosine, and the smaller one counts.
      return (2 + 1 / lobe.alpha_u) * (0.5f * kInvPi) /
             std::max(1.0f, sheen_albedo(std::sqrt(lobe.alpha_u), cos_o).raw);
    case LobeKind::clearcoat: {
      const float a2 = square(lobe.alpha_u);
      return masking(NormalDistribution::ggx, cos_o, kClearcoatMask) * kInvPi * (a2 - 1) / std::log(a2);
    }
    case LobeKind::hair_diffuse:
      return kInvPi * kInvPi;
    case LobeKind::hair_specular:
      return lobe.alpha_v;
    default:
      return kInvPi;
  }
}

Rgb term_bound(const LobeTerm& t, const AngleRange& r, Slant slant) {
  const float cosine = slant == Slant::cosine ? r.cos_hi : 1.0f;
  switch (t.lobe->kind) {
    case LobeKind::oren_nayar: {
      float direct, indirect;
      oren_nayar(t, r, slant, direct, indirect);
      return t.scale * direct + t.at_normal * indirect;
    }
    case LobeKind::microfacet_reflect:
      return t.scale * reflectance(t, r) * (normals(t, r) * masked(t, r, slant));
    case LobeKind::microfacet_transmit:
    case LobeKind::thin_transmit:
      return t.scale * (normals(t, r) * masked(t, r, slant));
    case LobeKind::phong:
      if (!(r.cos_mirror > 0)) return Rgb(0);
      return t.scale * (std::pow(r.cos_mirror, t.lobe->alpha_u) * cosine);
    case LobeKind::ward:
      return t.scale * ward(t, r, slant);
    case LobeKind::sheen:
      return t.scale * (schlick_weight(r.half_lo) * cosine);
    case LobeKind::charlie_sheen: {
      const float d = std::pow(r.most_tilt_sin, 1 / t.lobe->alpha_u);
      // c/(co + c - co·c) grows with c, and what is below it too.
      const float c = slant == Slant::cosine ? r.cos_hi : r.cos_lo;
      return t.scale * (d * cosine / (4 * (t.cos_o + c - t.cos_o * c)));
    }
    case LobeKind::disney_diffuse:
      return t.scale * disney_diffuse(t, r, slant);
    case LobeKind::clearcoat: {
      const float f = lerp(schlick_weight(r.half_lo), 1.0f, 0.04f);
      const float d = 1 / (square(r.tilt_sin) + square(t.lobe->alpha_u * r.tilt_cos));
      return t.scale * (f * d * masking(NormalDistribution::ggx, r.cos_hi, kClearcoatMask) * cosine);
    }
    default:
      return t.scale * cosine;  // matt; transmittances are at most 1
  }
}

Rgb fibre_term_bound(const LobeTerm& t, float latitude_o, float lo, float hi, Slant slant) {
  const float least_sine = std::min(std::cos(lo), std::cos(hi));  // of the angle to the fibre
  const float most_sine = lo <= 0 && hi >= 0 ? 1.0f : std::max(std::cos(lo), std::cos(hi));
  if (t.lobe->kind == LobeKind::hair_diffuse) return t.scale * (slant == Slant::cosine ? most_sine : 1.0f);
  const float from = latitude_o + lo, to = latitude_o + hi;
  const float off = from > 0 ? from : to < 0 ? -to : 0.0f;
  if (off >= kPi / 2) return Rgb(0);
  // c/max(co, c)² ≤ 1/max(co, c); the denominator does not count below 1e-8.
  const float larger = std::max({t.cos_o, least_sine, 1e-4f});
  const float share = slant == Slant::cosine
                          ? std::min(1 / larger, most_sine / square(std::max(t.cos_o, 1e-4f)))
                          : 1 / square(larger);
  return t.scale * (std::pow(std::cos(off), t.lobe->alpha_u) * share);
}

}  // namespace lumirank::scatter
