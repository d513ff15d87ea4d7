// Reflection and refraction by rough interfaces (Walter et al. 2007) with separable Smith masking, drawn
// through the visible normals.
#include "scatter/fresnel.h"
#include "scatter/lobe.h"
#include "scatter/microfacet.h"

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
Rgb thin_transmit_value(const Lobe& lobe, Vec3f wo, Vec3f wi) {
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

namespace {

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

}  // namespace

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

}  // namespace lumirank::scatter
