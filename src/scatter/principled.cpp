// The principled material (Burley 2012, 2015; weights as in Mitsuba 3): up to seven lobes. The blended
// Fresnel term is a sum of three, so it becomes three lobes over the same microfacets, of which mostly one or
// two have a colour.
#include "scatter/closure_builder.h"
#include "scatter/fresnel.h"

namespace lumirank::scatter {

void ClosureBuilder::leaf(const PrincipledMaterial& m, const SurfacePoint& at, float weight) {
  const TextureSet& textures = set_.textures;
  const auto input = [&](const FloatInput& f) { return fraction(textures, f, at.uv); };
  const Rgb base = reflectance(textures, m.base_color, at.uv);
  const float roughness = input(m.roughness), metallic = input(m.metallic), spec_trans = input(m.spec_trans);
  const float opaque = (1 - metallic) * (1 - spec_trans), clear = (1 - metallic) * spec_trans;

  Lobe spec;
  spec.kind = LobeKind::microfacet_reflect;
  spec.distribution = NormalDistribution::ggx;
  const float alpha = roughness * roughness, aspect = std::sqrt(1 - 0.9f * input(m.anisotropic));
  spec.alpha_u = std::clamp(alpha / aspect, 1e-3f, 4.0f);
  spec.alpha_v = std::max(1e-3f, alpha * aspect);
  spec.eta = m.eta;

  Lobe through = spec;
  through.kind = LobeKind::microfacet_transmit;
  through.fresnel = FresnelKind::dielectric;
  through.color = sqrt(base) * clear;
  const bool bends = std::abs(m.eta - 1) >= 1e-3f;
  if (!bends) through.kind = LobeKind::delta_pass;

  if (!front(at)) {
    if (clear == 0) return;
    spec.fresnel = FresnelKind::dielectric;
    spec.color = Rgb(clear);
    if (bends) push(spec, at, weight);
    push(through, at, weight);
    return;
  }

  const float brightness = luminance(base);
  const Rgb tint = brightness > 0 ? base / brightness : Rgb(1);
  const float spec_tint = input(m.spec_tint);
  spec.fresnel = FresnelKind::dielectric;
  spec.color = Rgb((1 - metallic) * (1 - spec_tint));
  push(spec, at, weight);
  spec.fresnel = FresnelKind::schlick;
  spec.color = Rgb((1 - metallic) * spec_tint);
  spec.conductor_eta = clamp_below(tint * square((m.eta - 1) / (m.eta + 1)), 1.0f);
  push(spec, at, weight);
  spec.color = Rgb(metallic);
  spec.conductor_eta = base;
  push(spec, at, weight);
  push(through, at, weight);

  Lobe diffuse;
  diffuse.kind = LobeKind::disney_diffuse;
  diffuse.color = base * opaque;
  diffuse.alpha_u = roughness;
  diffuse.extra = input(m.flatness);
  push(diffuse, at, weight);

  Lobe sheen;
  sheen.kind = LobeKind::sheen;
  sheen.color = lerp(Rgb(1), tint, input(m.sheen_tint)) * (input(m.sheen) * (1 - metallic));
  push(sheen, at, weight);

  Lobe coat;
  coat.kind = LobeKind::clearcoat;
  coat.color = Rgb(0.25f * input(m.clearcoat));
  coat.alpha_u = coat.alpha_v = lerp(0.1f, 0.001f, input(m.clearcoat_gloss));
  push(coat, at, weight);
}

}  // namespace lumirank::scatter
