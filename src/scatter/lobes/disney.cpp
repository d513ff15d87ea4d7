// The parts of the principled model that no other material has: diffuse with retro-reflection and flattening,
// sheen, and the clear coat (Burley 2012 and 2015; forms and constants as in Mitsuba 3's principled plugin).
#include "scatter/fresnel.h"
#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/family.h"
#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

// color/π · lerp(diffuse + retro, flat, flatness); alpha_u is the roughness, extra the flatness.
Rgb disney_diffuse_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  const float fo = schlick_weight(wo.z), fi = schlick_weight(wi.z);
  const float cos_d = dot(normalize(wo + wi), wi);
  const float rr = 2 * lobe.alpha_u * cos_d * cos_d;
  const float smooth = (1 - 0.5f * fo) * (1 - 0.5f * fi) + rr * (fo + fi + fo * fi * (rr - 1));
  float value = smooth;
  if (lobe.extra > 0) {
    const float ss90 = 0.5f * rr;
    const float ss = lerp(1.0f, ss90, fo) * lerp(1.0f, ss90, fi);
    const float flat = 1.25f * (ss * (1 / (wo.z + wi.z) - 0.5f) + 0.5f);
    value = lerp(smooth, flat, lobe.extra);
  }
  return lobe.color * (kInvPi * value);
}

// color · (1 - cos_d)⁵.
Rgb sheen_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  return lobe.color * schlick_weight(dot(normalize(wo + wi), wi));
}

constexpr float kCoatF0 = 0.04f, kCoatMaskAlpha = 0.25f;

// The generalized Trowbridge-Reitz distribution with exponent 1; alpha_u is its width.
// sin² + α²·cos² instead of 1 + (α² - 1)·cos²: near the pole the latter has no digits left.
float gtr1_d(Vec3f m, float alpha) {
  const float a2 = alpha * alpha;
  return (a2 - 1) / (kPi * std::log(a2) * (m.x * m.x + m.y * m.y + a2 * m.z * m.z));
}

// color · F · D · G; Mitsuba leaves out 1/(4 cos cos), and so do we.
Rgb clearcoat_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  const Vec3f m = normalize(wo + wi);
  const float f = lerp(schlick_weight(dot(wo, m)), 1.0f, kCoatF0);
  const float g = ggx_g1(wo, kCoatMaskAlpha, kCoatMaskAlpha) * ggx_g1(wi, kCoatMaskAlpha, kCoatMaskAlpha);
  return lobe.color * (f * gtr1_d(m, lobe.alpha_u) * g);
}

float clearcoat_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  const Vec3f m = normalize(wo + wi);
  return gtr1_d(m, lobe.alpha_u) * m.z / (4 * dot(wo, m));
}

bool clearcoat_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  const Lobe& lobe = view.lobe;
  const float a2 = lobe.alpha_u * lobe.alpha_u, phi = 2 * kPi * u.x;
  // 1 - cos², written so that it keeps its digits near the pole.
  const float sin2 = (std::pow(a2, 1 - u.y) - a2) / (1 - a2);
  const float r = std::sqrt(std::clamp(sin2, 0.0f, 1.0f));
  const Vec3f m{r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - r * r))};
  wi = reflect(wo, m);
  return dot(wo, m) > 0 && wi.z > 0;
}

float disney_diffuse_shape(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  const float fo = schlick_weight(t.cos_o), rr = 2 * t.lobe->alpha_u;
  // Linear in the weight of wi, so greatest at an end; it grows with rr.
  const auto smooth = [&](float fi) {
    return (1 - 0.5f * fo) * (1 - 0.5f * fi) + rr * (fo + fi + fo * fi * (rr - 1));
  };
  const float cosine = factor == CosineFactor::cosine ? r.cos_hi : 1.0f;
  float max_shape = std::max(smooth(schlick_weight(r.cos_lo)), smooth(schlick_weight(r.cos_hi))) * cosine;
  if (t.lobe->extra > 0) {
    // ss·(1/(co + ci) - 1/2) + 1/2, where ss ≤ 1 and the bracket is not negative.
    const float ss = square(std::max(1.0f, 0.5f * rr));
    const float flat =
        factor == CosineFactor::cosine ? r.cos_hi / (t.cos_o + r.cos_hi) : 1 / (t.cos_o + r.cos_lo);
    max_shape = lerp(max_shape, 1.25f * ss * flat, t.lobe->extra);
  }
  return max_shape;
}

Rgb disney_diffuse_bound(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  return t.scale * disney_diffuse_shape(t, r, factor);
}
UnderCoat disney_under_coat(LobeView view) { return {UnderCoat::Sort::diffuse, view.lobe.color}; }

// Of sheen and clear coat: both are Fresnel's curve above all.
float schlick_importance(LobeView view, float cos_o) {
  return mean(view.lobe.color) * std::max(kMinImportance, schlick_weight(cos_o));
}

float sheen_factor(const Lobe&, float, float) { return 1; }
Rgb sheen_bound(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  return t.scale * (schlick_weight(r.half_lo) * (factor == CosineFactor::cosine ? r.cos_hi : 1.0f));
}
float sheen_reach(const LobeTerm&) { return 1; }

float clearcoat_factor(const Lobe& lobe, float cos_o, float) {
  const float a2 = square(lobe.alpha_u);
  return masking(NormalDistribution::ggx, cos_o, kCoatMaskAlpha) * kInvPi * (a2 - 1) / std::log(a2);
}
Rgb clearcoat_bound(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  const float f = lerp(schlick_weight(r.half_lo), 1.0f, 0.04f);
  const float d = 1 / (square(r.tilt_sin) + square(t.lobe->alpha_u * r.tilt_cos));
  return t.scale * (f * d * masking(NormalDistribution::ggx, r.cos_hi, kCoatMaskAlpha) *
                    (factor == CosineFactor::cosine ? r.cos_hi : 1.0f));
}
float clearcoat_roughness(const Lobe& lobe) { return lobe.alpha_u; }

}  // namespace

constinit const LobeFamily disney_diffuse_family{.value = disney_diffuse_value,
                                                 .bound = disney_diffuse_bound,
                                                 .bound_by_cosine = true,
                                                 .under_coat = disney_under_coat,
                                                 .matt = true,
                                                 .lanes = LaneForm::disney_diffuse,
                                                 .half_vector = true};

constinit const LobeFamily sheen_family{.value = sheen_value,
                                        .importance = schlick_importance,
                                        .factor_of_wo = sheen_factor,
                                        .bound = sheen_bound,
                                        .reach = sheen_reach,
                                        .lanes = LaneForm::sheen,
                                        .half_vector = true};

constinit const LobeFamily clearcoat_family{.value = clearcoat_value,
                                            .pdf = clearcoat_pdf,
                                            .sample = clearcoat_sample,
                                            .importance = schlick_importance,
                                            .factor_of_wo = clearcoat_factor,
                                            .bound = clearcoat_bound,
                                            .roughness = clearcoat_roughness,
                                            .lanes = LaneForm::clearcoat,
                                            .half_vector = true};

}  // namespace lumirank::scatter
