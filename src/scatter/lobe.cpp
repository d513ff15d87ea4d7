// Dispatch over the families.
#include "scatter/lobe.h"

#include "base/warp.h"
#include "scatter/albedo_table.h"
#include "scatter/charlie_sheen.h"
#include "scatter/fresnel.h"
#include "scatter/interface.h"

namespace lumirank::scatter {
namespace {

Rgb interfaced_value(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  return lobe.color * (kInvPi * interface_transmittance(lobe, wo.z) * interface_transmittance(lobe, wi.z));
}

}  // namespace

Rgb quadrature_albedo(LobeView view, Vec3f wo) {
  // A Fibonacci lattice: no two-dimensional rule of so few points is much better.
  constexpr int count = 55, step = 34;
  Rgb sum(0);
  for (int k = 0; k < count; ++k) {
    const Vec2f u{(static_cast<float>(k) + 0.5f) / count,
                  (static_cast<float>(k * step % count) + 0.5f) / count};
    Vec3f wi;
    if (!lobe_sample(view, wo, u, wi)) continue;
    const float pdf = lobe_pdf(view, wo, wi);
    const float cosine = is_hair(view.lobe.kind) ? fibre_sine(wi) : std::abs(wi.z);
    if (pdf > 0) sum += lobe_value(view, wo, wi) * (cosine / pdf);
  }
  // As a share of energy: without the scaling of radiance.
  const float scale = view.lobe.kind == LobeKind::microfacet_transmit ? view.eta * view.eta : 1.0f;
  return sum * (scale / static_cast<float>(count));
}

bool draws_cosine(LobeKind kind) {
  return kind == LobeKind::diffuse || kind == LobeKind::oren_nayar || kind == LobeKind::interfaced_diffuse ||
         kind == LobeKind::sheen || kind == LobeKind::charlie_sheen || kind == LobeKind::disney_diffuse;
}

Rgb lobe_value(LobeView view, Vec3f wo, Vec3f wi) {
  return view.lobe.coat ? coated_value(view, wo, wi) : bare_value(view, wo, wi);
}
float lobe_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  return view.lobe.coat ? coated_pdf(view, wo, wi) : bare_pdf(view, wo, wi);
}
bool lobe_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  return view.lobe.coat ? coated_sample(view, wo, u, wi) : bare_sample(view, wo, u, wi);
}
Rgb lobe_albedo(LobeView view, Vec3f wo) {
  return view.lobe.coat ? coated_albedo(view, wo) : bare_albedo(view, wo);
}
float lobe_importance(LobeView view, float cos_o) {
  return view.lobe.coat ? coated_importance(view, cos_o) : bare_importance(view, cos_o);
}
bool delta_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient) {
  return view.lobe.coat ? coated_delta_direction(view, wo, wi, coefficient)
                        : bare_delta_direction(view, wo, wi, coefficient);
}

namespace {

Rgb unveiled_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  switch (lobe.kind) {
    case LobeKind::diffuse:
      return lobe.color * kInvPi;
    case LobeKind::oren_nayar:
      return oren_nayar_value(lobe, wo, wi);
    case LobeKind::interfaced_diffuse:
      return interfaced_value(lobe, wo, wi);
    case LobeKind::microfacet_reflect:
      return microfacet_reflect_value(view, wo, wi);
    case LobeKind::microfacet_transmit:
      return microfacet_transmit_value(view, wo, wi);
    case LobeKind::diffuse_transmit:
      return lobe.color * kInvPi;
    case LobeKind::thin_transmit:
      return thin_transmit_value(lobe, wo, wi);
    case LobeKind::phong:
      return phong_value(lobe, wo, wi);
    case LobeKind::ward:
      return ward_value(lobe, wo, wi);
    case LobeKind::sheen:
      return sheen_value(lobe, wo, wi);
    case LobeKind::charlie_sheen:
      return charlie_sheen_value(lobe, wo, wi);
    case LobeKind::disney_diffuse:
      return disney_diffuse_value(lobe, wo, wi);
    case LobeKind::clearcoat:
      return clearcoat_value(lobe, wo, wi);
    case LobeKind::hair_diffuse:
      return hair_diffuse_value(lobe);
    case LobeKind::hair_specular:
      return hair_specular_value(lobe, wo, wi);
    case LobeKind::delta_reflect:
    case LobeKind::delta_transmit:
    case LobeKind::delta_pass:
      break;
  }
  return Rgb(0);
}

}  // namespace

Rgb bare_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Rgb value = unveiled_value(view, wo, wi);
  return view.lobe.veil ? value * veil_factor(view.lobe.veil, std::min(wo.z, wi.z)) : value;
}

float bare_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  switch (lobe.kind) {
    case LobeKind::diffuse:
    case LobeKind::oren_nayar:
    case LobeKind::interfaced_diffuse:
    case LobeKind::sheen:
    case LobeKind::charlie_sheen:
    case LobeKind::disney_diffuse:
      return pdf_cosine_hemisphere(wi.z);
    case LobeKind::microfacet_reflect:
      return microfacet_reflect_pdf(view, wo, wi);
    case LobeKind::microfacet_transmit:
      return microfacet_transmit_pdf(view, wo, wi);
    case LobeKind::diffuse_transmit:
      return pdf_cosine_hemisphere(-wi.z);
    case LobeKind::thin_transmit:
      return thin_transmit_pdf(view, wo, wi);
    case LobeKind::phong:
      return phong_pdf(lobe, wo, wi);
    case LobeKind::ward:
      return ward_pdf(lobe, wo, wi);
    case LobeKind::clearcoat:
      return clearcoat_pdf(lobe, wo, wi);
    case LobeKind::hair_diffuse:
      return 1 / (4 * kPi);
    case LobeKind::hair_specular:
      return hair_specular_pdf(lobe, wo, wi);
    case LobeKind::delta_reflect:
    case LobeKind::delta_transmit:
    case LobeKind::delta_pass:
      break;
  }
  return 0;
}

bool bare_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  const Lobe& lobe = view.lobe;
  switch (lobe.kind) {
    case LobeKind::diffuse:
    case LobeKind::oren_nayar:
    case LobeKind::interfaced_diffuse:
    case LobeKind::sheen:
    case LobeKind::charlie_sheen:
    case LobeKind::disney_diffuse:
      wi = warp_cosine_hemisphere(u);
      return wi.z > 0;
    case LobeKind::microfacet_reflect:
      return microfacet_reflect_sample(view, wo, u, wi);
    case LobeKind::microfacet_transmit:
      return microfacet_transmit_sample(view, wo, u, wi);
    case LobeKind::diffuse_transmit:
      wi = -warp_cosine_hemisphere(u);
      return wi.z < 0;
    case LobeKind::thin_transmit:
      return thin_transmit_sample(view, wo, u, wi);
    case LobeKind::phong:
      return phong_sample(lobe, wo, u, wi);
    case LobeKind::ward:
      return ward_sample(lobe, wo, u, wi);
    case LobeKind::clearcoat:
      return clearcoat_sample(lobe, wo, u, wi);
    case LobeKind::hair_diffuse:
      wi = warp_sphere(u);
      return true;
    case LobeKind::hair_specular:
      return hair_specular_sample(lobe, wo, u, wi);
    case LobeKind::delta_reflect:
    case LobeKind::delta_transmit:
    case LobeKind::delta_pass:
      break;
  }
  return false;
}

Rgb bare_albedo(LobeView view, Vec3f wo) {
  const Lobe& lobe = view.lobe;
  if (lobe.veil && !is_delta(lobe.kind)) return quadrature_albedo(view, wo);
  if (lobe.kind == LobeKind::charlie_sheen) return charlie_sheen_albedo(lobe, wo.z);
  if (lobe.kind == LobeKind::diffuse || lobe.kind == LobeKind::diffuse_transmit ||
      lobe.kind == LobeKind::hair_diffuse)
    return lobe.color;
  if (lobe.kind == LobeKind::interfaced_diffuse)
    return lobe.color * (interface_transmittance(lobe, wo.z) * lobe.alpha_v);
  if (is_delta(lobe.kind)) {
    Vec3f wi;
    Rgb coefficient;
    return bare_delta_direction(view, wo, wi, coefficient) ? coefficient : Rgb(0);
  }
  // Total internal reflection is no matter of Schlick's curve: the table is for the outside.
  if (lobe.kind == LobeKind::microfacet_reflect && lobe.alpha_u == lobe.alpha_v && lobe.alpha_u <= 1 &&
      (lobe.fresnel != FresnelKind::dielectric || view.eta > 1))
    return microfacet_reflect_albedo(view, wo.z);
  return quadrature_albedo(view, wo);
}

namespace {

float unveiled_importance(LobeView view, float cos_o) {
  const Lobe& lobe = view.lobe;
  const float scale = mean(lobe.color);
  // Microfacets may reflect or refract where the macroscopic surface does not: never below a twentieth.
  constexpr float least = 0.05f;
  switch (lobe.kind) {
    case LobeKind::interfaced_diffuse:
      return scale * std::max(least, interface_transmittance(lobe, cos_o)) * lobe.alpha_v;
    case LobeKind::microfacet_reflect:
      return std::max(least * scale, mean(lobe.color * lobe_fresnel(view, cos_o)));
    case LobeKind::microfacet_transmit:
      return scale * std::max(least, 1 - fresnel_dielectric(cos_o, view.eta));
    case LobeKind::thin_transmit:
      return scale * std::max(least, 1 - fresnel_dielectric(cos_o, lobe.eta));
    case LobeKind::sheen:
      return scale * std::max(least, schlick_weight(cos_o));
    case LobeKind::charlie_sheen:
      return scale * std::max(least, sheen_albedo(std::sqrt(lobe.alpha_u), cos_o).held);
    case LobeKind::clearcoat:
      return scale * std::max(least, schlick_weight(cos_o));
    default:
      return scale;
  }
}

}  // namespace

float bare_importance(LobeView view, float cos_o) {
  const Veil& veil = view.lobe.veil;
  return unveiled_importance(view, cos_o) * (veil ? std::max(0.05f, veil_factor(veil, cos_o)) : 1.0f);
}

}  // namespace lumirank::scatter
