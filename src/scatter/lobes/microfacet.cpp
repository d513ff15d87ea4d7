// Reflection and refraction by rough interfaces (Walter et al. 2007) with separable Smith masking, drawn
// through the visible normals.
#include "scatter/microfacet.h"
#include "scatter/albedo_table.h"
#include "scatter/fresnel.h"
#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {

Rgb lobe_fresnel(LobeView view, float cos_m) {
  const Lobe& lobe = view.lobe;
  switch (lobe.fresnel) {
    case FresnelKind::dielectric:
      return Rgb(fresnel_dielectric(cos_m, view.eta));
    case FresnelKind::conductor:
      return fresnel_conductor(cos_m, lobe.conductor_eta, lobe.conductor_k);
    case FresnelKind::schlick:
      return fresnel_schlick(cos_m, lobe.conductor_eta);
    case FresnelKind::none:
      break;
  }
  return Rgb(1);
}

namespace {

Rgb microfacet_reflect_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  const Vec3f m = normalize(wo + wi);
  const float d = microfacet_d(lobe.distribution, m, lobe.alpha_u, lobe.alpha_v);
  const float g = microfacet_g1(lobe.distribution, wo, lobe.alpha_u, lobe.alpha_v) *
                  microfacet_g1(lobe.distribution, wi, lobe.alpha_u, lobe.alpha_v);
  return lobe.color * lobe_fresnel(view, dot(wo, m)) * (d * g / (4 * wo.z * wi.z));
}

float microfacet_reflect_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  const Vec3f m = normalize(wo + wi);
  // The cosine wo·m of the visible normals' density cancels against the Jacobian 1/(4 wo·m).
  return microfacet_g1(lobe.distribution, wo, lobe.alpha_u, lobe.alpha_v) *
         microfacet_d(lobe.distribution, m, lobe.alpha_u, lobe.alpha_v) / (4 * wo.z);
}

bool microfacet_reflect_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  const Lobe& lobe = view.lobe;
  wi = reflect(wo, sample_visible_normal(lobe.distribution, wo, u, lobe.alpha_u, lobe.alpha_v));
  return wi.z > 0;
}

// A sheet without thickness: what is not reflected goes on as if reflected at its other side.
Rgb thin_transmit_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  wi.z = -wi.z;
  const Vec3f m = normalize(wo + wi);
  const float d = microfacet_d(lobe.distribution, m, lobe.alpha_u, lobe.alpha_v);
  const float g = microfacet_g1(lobe.distribution, wo, lobe.alpha_u, lobe.alpha_v) *
                  microfacet_g1(lobe.distribution, wi, lobe.alpha_u, lobe.alpha_v);
  return lobe.color * ((1 - fresnel_dielectric(dot(wo, m), lobe.eta)) * d * g / (4 * wo.z * wi.z));
}
float thin_transmit_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  return microfacet_reflect_pdf(view, wo, {wi.x, wi.y, -wi.z});
}
bool thin_transmit_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  if (!microfacet_reflect_sample(view, wo, u, wi)) return false;
  wi.z = -wi.z;
  return true;
}

// The normal that refracts wo into wi, and the Jacobian's denominator; false if there is none.
struct Refraction {
  Vec3f m;
  float cos_o, cos_i;  // wo·m > 0 and wi·m < 0
  float denominator;   // (wo·m + eta·wi·m)²
};
bool refraction(float eta, Vec3f wo, Vec3f wi, Refraction& r) {
  const Vec3f h = wo + wi * eta;
  const float len2 = length_squared(h);
  if (!(len2 > 1e-16f)) return false;
  r.m = h / std::sqrt(len2);
  if (r.m.z < 0) r.m = -r.m;
  r.cos_o = dot(wo, r.m), r.cos_i = dot(wi, r.m);
  if (!(r.cos_o > 0 && r.cos_i < 0)) return false;
  r.denominator = square(r.cos_o + eta * r.cos_i);
  return r.denominator > 0;
}

// For radiance that flows from wi to wo.
Rgb microfacet_transmit_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  Refraction r;
  if (!refraction(view.eta, wo, wi, r)) return Rgb(0);
  const float d = microfacet_d(lobe.distribution, r.m, lobe.alpha_u, lobe.alpha_v);
  const float g = microfacet_g1(lobe.distribution, wo, lobe.alpha_u, lobe.alpha_v) *
                  microfacet_g1(lobe.distribution, wi, lobe.alpha_u, lobe.alpha_v);
  const float t = fresnel_transmittance(r.cos_o, -r.cos_i, view.eta);
  return lobe.color * (t * d * g * r.cos_o * -r.cos_i / (wo.z * -wi.z * r.denominator));
}

float microfacet_transmit_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  Refraction r;
  if (!refraction(view.eta, wo, wi, r)) return 0;
  const float visible = visible_normal_pdf(lobe.distribution, wo, r.m, lobe.alpha_u, lobe.alpha_v);
  return visible * square(view.eta) * -r.cos_i / r.denominator;
}

bool microfacet_transmit_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  const Lobe& lobe = view.lobe;
  const Vec3f m = sample_visible_normal(lobe.distribution, wo, u, lobe.alpha_u, lobe.alpha_v);
  const float c = dot(wo, m);
  if (!(c > 0)) return false;
  const float cos_t2 = 1 - (1 - c * c) / square(view.eta);
  if (!(cos_t2 > 0)) return false;
  wi = normalize(m * (c / view.eta - std::sqrt(cos_t2)) - wo / view.eta);
  return wi.z < 0;
}

bool roughly_in_table(LobeView view) { return view.roughly && table_tells_roughly(view.lobe); }

// Total internal reflection is no matter of Schlick's curve: the table is for the outside.
Rgb reflect_albedo(LobeView view, Vec3f wo) {
  const Lobe& lobe = view.lobe;
  const bool in_table = lobe.alpha_u == lobe.alpha_v && lobe.alpha_u <= 1 &&
                        (lobe.fresnel != FresnelKind::dielectric || view.eta > 1);
  return in_table || roughly_in_table(view) ? microfacet_reflect_albedo(view, wo.z)
                                            : quadrature_albedo(view, wo);
}

Rgb transmit_albedo(LobeView view, Vec3f wo) {
  return roughly_in_table(view) ? rough_transmit_albedo(view, view.eta, wo.z) : quadrature_albedo(view, wo);
}
Rgb thin_albedo(LobeView view, Vec3f wo) {
  return roughly_in_table(view) ? rough_transmit_albedo(view, view.lobe.eta, wo.z)
                                : quadrature_albedo(view, wo);
}

float reflect_importance(LobeView view, float cos_o) {
  const Lobe& lobe = view.lobe;
  return std::max(kMinImportance * mean(lobe.color), mean(lobe.color * lobe_fresnel(view, cos_o)));
}
float transmit_importance(LobeView view, float cos_o) {
  return mean(view.lobe.color) * std::max(kMinImportance, 1 - fresnel_dielectric(cos_o, view.eta));
}
float thin_importance(LobeView view, float cos_o) {
  return mean(view.lobe.color) * std::max(kMinImportance, 1 - fresnel_dielectric(cos_o, view.lobe.eta));
}

float min_alpha(const Lobe& lobe) { return std::min(lobe.alpha_u, lobe.alpha_v); }

UnderCoat reflect_under_coat(LobeView view) {
  const Lobe& lobe = view.lobe;
  const float alpha = std::sqrt(lobe.alpha_u * lobe.alpha_v);
  Lobe round = lobe;
  round.alpha_u = round.alpha_v = std::min(1.0f, alpha);
  const LobeView seen{round, view.eta, view.outside};
  return {UnderCoat::Sort::glossy,
          microfacet_reflect_albedo(seen, 1),
          microfacet_reflect_albedo(seen, 0.5f),
          lobe.distribution,
          round.alpha_u,
          alpha};
}
void widen_facets(Lobe& lobe, const Widening& by) {
  lobe.alpha_u = by(lobe.alpha_u), lobe.alpha_v = by(lobe.alpha_v);
}

float ndf_bound(const LobeTerm& t, const AngleRange& r) {
  const float scale = kInvPi / (t.widest * t.narrowest);
  if (t.lobe->distribution == NormalDistribution::beckmann) return scale * gaussian_slopes(r, t.widest);
  float q = square(r.tilt_sin / t.widest) + square(r.tilt_cos);
  if (t.widest > 1) q = std::min(q, 1 / square(t.widest));
  return scale / (q * q);
}

// G1, or G1 over the cosine: bounded at grazing angles.
float masking_bound(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  if (factor == CosineFactor::cosine) return masking(t.lobe->distribution, r.cos_hi, t.narrowest);
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
  const Rgb at_half = lobe_fresnel({*t.lobe, t.eta, true}, r.half_lo);
  return {std::max(t.at_normal.r, at_half.r), std::max(t.at_normal.g, at_half.g),
          std::max(t.at_normal.b, at_half.b)};
}

float reflect_factor(const Lobe& lobe, float cos_o, float narrowest) {
  return masking(lobe.distribution, cos_o, narrowest) / (4 * cos_o);
}
float transmit_factor(const Lobe& lobe, float cos_o, float narrowest) {
  return masking(lobe.distribution, cos_o, narrowest) / cos_o;
}
Rgb reflect_bound(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  return t.scale * reflectance(t, r) * (ndf_bound(t, r) * masking_bound(t, r, factor));
}
Rgb transmit_bound(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  return t.scale * (ndf_bound(t, r) * masking_bound(t, r, factor));
}

}  // namespace

constinit const LobeFamily microfacet_reflect_family{.value = microfacet_reflect_value,
                                                     .pdf = microfacet_reflect_pdf,
                                                     .sample = microfacet_reflect_sample,
                                                     .albedo = reflect_albedo,
                                                     .importance = reflect_importance,
                                                     .factor_of_wo = reflect_factor,
                                                     .bound = reflect_bound,
                                                     .roughness = min_alpha,
                                                     .under_coat = reflect_under_coat,
                                                     .widen = widen_facets,
                                                     .fresnel = true,
                                                     .two_widths = true,
                                                     .lanes = LaneForm::microfacet_reflect,
                                                     .half_vector = true};

constinit const LobeFamily microfacet_transmit_family{.value = microfacet_transmit_value,
                                                      .pdf = microfacet_transmit_pdf,
                                                      .sample = microfacet_transmit_sample,
                                                      .albedo = transmit_albedo,
                                                      .importance = transmit_importance,
                                                      .factor_of_wo = transmit_factor,
                                                      .bound = transmit_bound,
                                                      .roughness = min_alpha,
                                                      .refracts = true};

constinit const LobeFamily thin_transmit_family{.value = thin_transmit_value,
                                                .pdf = thin_transmit_pdf,
                                                .sample = thin_transmit_sample,
                                                .albedo = thin_albedo,
                                                .importance = thin_importance,
                                                .factor_of_wo = reflect_factor,
                                                .bound = transmit_bound,
                                                .roughness = min_alpha,
                                                .two_widths = true,
                                                .lanes = LaneForm::thin_transmit};

}  // namespace lumirank::scatter
