// The principled material (Burley 2012, 2015; weights as in Mitsuba 3): up to eight lobes. The blended
// Fresnel term is a sum of three, so it becomes three lobes over the same microfacets, of which mostly one or
// two have a color.
#include "scatter/closure_builder.h"
#include "scatter/fresnel.h"
#include "scatter/interface.h"

namespace lumirank::scatter {
namespace {

void set_roughness(Lobe& lobe, float roughness, float anisotropic) {
  const float alpha = roughness * roughness, aspect = std::sqrt(1 - 0.9f * anisotropic);
  lobe.alpha_u = std::clamp(alpha / aspect, 1e-3f, 4.0f);
  lobe.alpha_v = std::max(1e-3f, alpha * aspect);
}

// Reflection by GGX.
Lobe rough_reflection(float roughness, float anisotropic, float eta) {
  Lobe lobe;
  lobe.kind = LobeKind::microfacet_reflect;
  lobe.distribution = NormalDistribution::ggx;
  set_roughness(lobe, roughness, anisotropic);
  lobe.eta = eta;
  return lobe;
}

// The hue of a color at luminance 1.
Rgb tint_of(Rgb base) {
  const float brightness = luminance(base);
  return brightness > 0 ? base / brightness : Rgb(1);
}
Rgb tinted_f0(Rgb tint, float eta) { return clamp_below(tint * square((eta - 1) / (eta + 1)), 1.0f); }

}  // namespace

void add_lobes(const PrincipledMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  const TextureSet& textures = out.textures();
  const auto input = [&](const FloatInput& f) { return fraction(textures, f, at.uv); };
  const Rgb base = reflectance(textures, m.base_color, at.uv);
  const float roughness = input(m.roughness), metallic = input(m.metallic), spec_trans = input(m.spec_trans);
  const float opaque = (1 - metallic) * (1 - spec_trans), clear = (1 - metallic) * spec_trans;

  Lobe spec = rough_reflection(roughness, input(m.anisotropic), m.eta);
  if (const float stretch = input(m.stretch); stretch > 0)
    spec.alpha_u = stretched_alpha(std::min(spec.alpha_u, 1.0f), stretch);

  Lobe through = spec;
  through.kind = LobeKind::microfacet_transmit;
  through.fresnel = FresnelKind::dielectric;
  through.color = sqrt(base) * clear;
  const bool bends = std::abs(m.eta - 1) >= 1e-3f;
  if (!bends) through.kind = LobeKind::delta_pass;

  if (!out.front(at)) {
    if (clear == 0) return;
    spec.fresnel = FresnelKind::dielectric;
    spec.color = Rgb(clear);
    if (bends) out.push(spec, at, weight);
    out.push(through, at, weight);
    return;
  }

  const Rgb tint = tint_of(base);
  const float spec_tint = input(m.spec_tint);
  spec.fresnel = FresnelKind::dielectric;
  spec.color = Rgb((1 - metallic) * (1 - spec_tint));
  out.push(spec, at, weight);
  spec.fresnel = FresnelKind::schlick;
  spec.color = Rgb((1 - metallic) * spec_tint);
  spec.conductor_eta = tinted_f0(tint, m.eta);
  out.push(spec, at, weight);
  spec.color = Rgb(metallic);
  spec.conductor_eta = base;
  out.push(spec, at, weight);
  if (m.lossless && metallic > 0) {
    Lobe masked = masked_reflection_lobe(base, spec.distribution, std::sqrt(spec.alpha_u * spec.alpha_v));
    masked.color *= metallic;
    out.push(masked, at, weight);
  }
  out.push(through, at, weight);

  Lobe diffuse;
  diffuse.kind = LobeKind::disney_diffuse;
  diffuse.color = base * opaque;
  diffuse.alpha_u = roughness;
  diffuse.extra = input(m.flatness);
  out.push(diffuse, at, weight);

  Lobe sheen;
  sheen.kind = LobeKind::sheen;
  sheen.color = lerp(Rgb(1), tint, input(m.sheen_tint)) * (input(m.sheen) * (1 - metallic));
  out.push(sheen, at, weight);

  Lobe coat;
  coat.kind = LobeKind::clearcoat;
  coat.color = Rgb(0.25f * input(m.clearcoat));
  coat.alpha_u = coat.alpha_v = lerp(0.1f, 0.001f, input(m.clearcoat_gloss));
  out.push(coat, at, weight);
}

// The share spec_trans of the sheet is a rough window, which reflects colorless light and tints what it lets
// through; the rest is matt and sends diff_trans/2 of its color to the other side.
void add_lobes(const PrincipledThinMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  const TextureSet& textures = out.textures();
  const auto input = [&](const FloatInput& f) { return fraction(textures, f, at.uv); };
  const Rgb base = reflectance(textures, m.base_color, at.uv), tint = tint_of(base);
  const float roughness = input(m.roughness), anisotropic = input(m.anisotropic);
  const float window = input(m.spec_trans), matt = 1 - window;
  const float back = matt * 0.5f * std::clamp(number(textures, m.diff_trans, at.uv), 0.0f, 2.0f);

  // Light comes from outside on either side.
  Lobe spec = rough_reflection(roughness, anisotropic, out.front(at) ? m.eta : 1 / m.eta);
  const float spec_tint = input(m.spec_tint);
  spec.fresnel = FresnelKind::dielectric;
  spec.color = Rgb(window * (1 - spec_tint));
  out.push(spec, at, weight);
  spec.fresnel = FresnelKind::schlick;
  spec.color = Rgb(window * spec_tint);
  spec.conductor_eta = tinted_f0(tint, m.eta);
  out.push(spec, at, weight);

  Lobe through;
  through.kind = LobeKind::thin_transmit;
  through.distribution = NormalDistribution::ggx;
  // Burley 2015: refraction in and out blurs less than a reflection.
  set_roughness(through, std::clamp((0.65f * m.eta - 0.35f) * roughness, 0.0f, 1.0f), anisotropic);
  through.eta = m.eta;
  through.color = base * window;
  out.push(through, at, weight);

  Lobe diffuse;
  diffuse.kind = LobeKind::disney_diffuse;
  diffuse.color = base * (matt - back);
  diffuse.alpha_u = roughness;
  diffuse.extra = input(m.flatness);
  out.push(diffuse, at, weight);
  Lobe sheen;
  sheen.kind = LobeKind::sheen;
  sheen.color = lerp(Rgb(1), tint, input(m.sheen_tint)) * (input(m.sheen) * (matt - back));
  out.push(sheen, at, weight);
  Lobe behind;
  behind.kind = LobeKind::diffuse_transmit;
  behind.color = base * back;
  out.push(behind, at, weight);
}

}  // namespace lumirank::scatter
