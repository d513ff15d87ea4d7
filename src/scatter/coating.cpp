// A dielectric layer over any material, as a sum of lobes: the layer's own reflection; every nested lobe seen
// through it (coat.h), widened by what a rough layer scatters; and one diffuse lobe for the light that the
// layer throws back inside.
//
// Light that the layer returns at the least reflectance R0 it can have stays in its lobe: 1 + a·R0 + … =
// 1/(1 - a·R0), a being the lobe's albedo. What is returned beyond that (total internal reflection of broad
// lobes) has forgotten its direction: with r the share returned of a lobe and rd that of diffuse light,
// M = (Σ a)·Σ a·(r - R0)/(1 - rd·Σ a) is the reflectance of the diffuse lobe. For a diffuse base the sum is
// the exact ρ/(1 - ρ·rd). Every term is reciprocal. Glossy lobes: part of what is returned beyond R0 comes
// back to the lobe (coat_return()) and the rest is lost in the masking of further bounces; the two numbers
// kTrapped and kBeyond were chosen by comparison with a random walk between the two surfaces
// (docs/decisions.md).
#include <array>
#include <cmath>

#include "base/error.h"
#include "scatter/closure_builder.h"
#include "scatter/coat.h"
#include "scatter/interface.h"
#include "scatter/lobes/charlie_sheen.h"
#include "scatter/lobes/family.h"
#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

// What one layer is, at a point.
struct Layer {
  Coat coat;                            // over diffuse and transmitting lobes
  float twice[6] = {0, 1, 0, 0, 0, 0};  // the transmittance's coefficients over glossy lobes
  NormalDistribution distribution = NormalDistribution::ggx;
  float alpha = 0;  // 0: smooth
  float diffuse_transmittance = 1;
  float r0 = 0;           // at normal incidence
  float scale = 1;        // of what is reflected below
  bool straight = false;  // see CoatingDesc
  Rgb diffuse_return{0};  // rd, absorption on the way up and down included
};

// Four-point Gauss-Legendre rule on [0, 1].
constexpr std::array<float, 4> kNodes{0.0694318f, 0.3300095f, 0.6699905f, 0.9305682f};
constexpr std::array<float, 4> kWeights{0.1739274f, 0.3260726f, 0.3260726f, 0.1739274f};

// The share of the light returned inside that is not absorbed on its way up and down, light being diffuse:
// ∫R(μ)·exp(-2·depth/μ)μ dμ / ∫R(μ)μ dμ, split at the critical angle.
float left_by_absorption(float eta, float depth) {
  if (!(depth > 0)) return 1;
  const float critical = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0.0f;
  float all = 0, left = 0;
  const auto add = [&](float from, float to) {
    for (std::size_t k = 0; k < kNodes.size(); ++k) {
      const float mu = from + (to - from) * kNodes[k];
      const float flux = (to - from) * kWeights[k] * mu * fresnel_dielectric(mu, 1 / eta);
      all += flux, left += flux * std::exp(-2 * depth / mu);
    }
  };
  add(0, critical), add(critical, 1);
  return all > 0 ? left / all : 1.0f;
}

// As the base of lossless plastic (interface.h): what the layer does not reflect on the way in and out, and
// what that leaves of diffuse light only once.
Layer straight_layer(float eta, float weight, NormalDistribution distribution, float alpha) {
  const InterfaceCoefficients k = interface_coefficients(distribution, alpha, eta);
  Layer layer;
  layer.distribution = distribution, layer.alpha = alpha, layer.straight = true;
  layer.coat.eta = eta;
  for (int i = 0; i < 6; ++i) layer.coat.t[i] = weight * k.left[i];
  layer.coat.t[0] += 1 - weight;
  std::copy(layer.coat.t, layer.coat.t + 6, layer.twice);
  layer.diffuse_transmittance = 1 - weight + weight * k.diffuse_left;
  layer.scale = 1 / layer.diffuse_transmittance;
  return layer;
}

Layer make_layer(float eta, float weight, Rgb depth, NormalDistribution distribution, float alpha) {
  const InterfaceCoefficients k = interface_coefficients(distribution, alpha, eta);
  Layer layer;
  layer.distribution = distribution, layer.alpha = alpha;
  Coat& coat = layer.coat;
  coat.eta = eta, coat.bend = 1 + weight * (eta - 1), coat.depth = depth * weight;
  for (int i = 0; i < 6; ++i) coat.t[i] = weight * k.c[i], layer.twice[i] = weight * k.twice[i];
  coat.t[0] += 1 - weight, layer.twice[0] += 1 - weight;
  layer.diffuse_transmittance = 1 - weight + weight * k.diffuse_transmittance;
  layer.r0 = weight * square((eta - 1) / (eta + 1));
  // What the interface neither transmits nor reflects (masked by its own facets) is lost.
  const float lost = 1 - k.internal_reflectance - k.diffuse_transmittance / (eta * eta);
  const float returned =
      std::max(0.0f, 1 - layer.diffuse_transmittance / (coat.bend * coat.bend) - weight * lost);
  for (int c = 0; c < 3; ++c) layer.diffuse_return[c] = returned * left_by_absorption(eta, coat.depth[c]);
  return layer;
}

// The share of a glossy lobe's light that the layer returns: light falls in vertically, facets of roughness
// alpha reflect it, the layer reflects what comes at a slant. No direction of incidence has less.
Rgb glossy_return(const Layer& layer, NormalDistribution distribution, float alpha) {
  Rgb sum(0);
  float all = 0;
  for (std::size_t k = 0; k < kNodes.size(); ++k) {
    const float u = kNodes[k];
    const float tan2 =
        alpha * alpha * (distribution == NormalDistribution::ggx ? u / (1 - u) : -std::log(1 - u));
    const float cos_m2 = 1 / (1 + tan2), mu = 2 * cos_m2 - 1;
    if (!(mu > 0)) continue;
    const float g = kWeights[k];
    const float r = fresnel_dielectric(mu, 1 / layer.coat.eta);
    all += g;
    for (int c = 0; c < 3; ++c) sum[c] += g * r * std::exp(-2 * layer.coat.depth[c] / mu);
  }
  const float weight = layer.r0 / square((layer.coat.eta - 1) / (layer.coat.eta + 1) + 1e-12f);
  return all > 0 ? sum * (weight / all) : Rgb(0);
}

// Directions that a rough layer bends on the way in and out: the variance of slopes that it adds to facets
// underneath, as in Belcour 2018. A facet that tilts by δ turns the direction inside by (1 -
// cos/(eta·cos'))·δ, so more at a slant: taken at the mean cosine.
Widening widening(const Layer& layer) {
  constexpr float cosine = 2.0f / 3;
  const float turned = 1 - cosine / (layer.coat.bend * coat_cosine(layer.coat, cosine));
  return {layer.distribution, turned * layer.alpha};
}

void widen(const Layer& layer, Lobe& lobe) {
  const auto family_widen = family_of(lobe.kind).widen;
  if (layer.alpha > 0 && !layer.straight && family_widen) family_widen(lobe, widening(layer));
}

constexpr float kTrapped = 1.5f, kBeyond = 0.7f;

struct Base {
  Rgb albedo{0};      // of light that comes vertically
  Rgb returned{0};    // the part of it that the layer returns beyond R0 and that leaves in all directions
  float trapped = 0;  // of Coat
};
Base glossy_base(const Layer& layer, Rgb albedo, Rgb oblique_albedo, NormalDistribution distribution,
                 float alpha) {
  Rgb beyond = glossy_return(layer, distribution, alpha);
  for (int c = 0; c < 3; ++c)
    beyond[c] = std::max(0.0f, beyond[c] - layer.r0 * std::exp(-2 * layer.coat.depth[c]));
  const float again = mean(oblique_albedo);  // the albedo of a further bounce
  // A layer rougher than what it covers has no sharp critical angle.
  const float sharp = alpha * alpha / (alpha * alpha + layer.alpha * layer.alpha);
  return {albedo, albedo * beyond * (kBeyond * again), kTrapped * mean(albedo) * again * again * sharp};
}

UnderCoat under_coat(LobeView view) {
  const auto family_under_coat = family_of(view.lobe.kind).under_coat;
  return family_under_coat ? family_under_coat(view) : UnderCoat{};
}

// What the layer needs to know of a nested lobe. Sheen and clear coat send back next to nothing, and what is
// transmitted is gone.
Base base_of(const Layer& layer, const UnderCoat& lobe) {
  if (layer.straight) return {};
  if (lobe.sort == UnderCoat::Sort::glossy)
    return glossy_base(layer, lobe.albedo, lobe.oblique_albedo, lobe.distribution, lobe.alpha);
  return lobe.sort == UnderCoat::Sort::diffuse ? Base{lobe.albedo, lobe.albedo * layer.diffuse_return}
                                               : Base{};
}

// A Lambertian lobe under the layer; without absorption it is plastic's base, which needs no coat.
Lobe diffuse_under(const Layer& layer, Rgb color) {
  Lobe lobe;
  lobe.color = color;
  lobe.coat = layer.coat;
  if (!is_black(layer.coat.depth)) return lobe;
  lobe.kind = LobeKind::interfaced_diffuse;
  lobe.coat = Coat{};
  lobe.distribution = layer.distribution;
  lobe.alpha_u = layer.alpha;
  lobe.alpha_v = layer.diffuse_transmittance;
  lobe.eta = layer.coat.eta;
  const float* t = layer.coat.t;
  lobe.conductor_eta = {t[0], t[1], t[2]};
  lobe.conductor_k = {t[3], t[4], t[5]};
  lobe.color = color / (layer.coat.bend * layer.coat.bend);
  return lobe;
}

// A glossy lobe under the layer, or one of which nothing comes back.
Lobe lobe_under(const Layer& layer, const UnderCoat& nested, const Base& base, Lobe lobe) {
  lobe.coat = layer.coat;
  if (nested.sort != UnderCoat::Sort::glossy) return lobe;
  std::copy(layer.twice, layer.twice + 6, lobe.coat.t);
  lobe.coat.trapped = base.trapped;
  // Normals of GGX have long tails.
  const bool long_tail = nested.distribution == NormalDistribution::ggx;
  lobe.coat.width = (long_tail ? 1.0f : 0.6f) * nested.width / lobe.coat.bend;
  for (int c = 0; c < 3; ++c) {
    const float stays = layer.r0 * std::exp(-2 * layer.coat.depth[c]);
    lobe.color[c] /= 1 - std::min(base.albedo[c], 1.0f) * stays;
  }
  return lobe;
}

struct LayerHere {
  Layer layer;
  float covered = 0, alpha_u = 0, alpha_v = 0;
};
LayerHere layer_at(const TextureSet& textures, const CoatingMaterial& m, const SurfacePoint& at) {
  LayerHere here;
  here.covered = fraction(textures, m.weight, at.uv);
  if (here.covered == 0) return here;
  if (!m.smooth) {
    here.alpha_u = rough_alpha(textures, m.alpha_u, at.uv);
    here.alpha_v = rough_alpha(textures, m.alpha_v, at.uv);
  }
  const float alpha = std::sqrt(here.alpha_u * here.alpha_v);
  here.layer = m.straight ? straight_layer(m.eta, here.covered, m.distribution, alpha)
                          : make_layer(m.eta, here.covered, positive_color(textures, m.absorption, at.uv),
                                       m.distribution, alpha);
  return here;
}

}  // namespace

Rgb coating_passage(const TextureSet& textures, const CoatingMaterial& m, const SurfacePoint& at, Vec3f w) {
  const LayerHere here = layer_at(textures, m, at);
  return here.covered > 0 ? coat_passage(here.layer.coat, std::abs(dot(w, at.shading.n))) : Rgb(1);
}

void add_lobes(const CoatingMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  const LayerHere here = layer_at(out.textures(), m, at);
  if (here.covered == 0) return out.add(m.nested, at, weight);
  const Layer& layer = here.layer;

  ClosureBuilder inner = out.inside();
  inner.add(m.nested, at, 1);
  const Closure nested = inner.finish(at);
  SurfacePoint point = at;
  point.shading = nested.frame, point.ng = nested.ng;

  if (out.front(at)) {
    Lobe own;
    own.kind = m.smooth ? LobeKind::delta_reflect : LobeKind::microfacet_reflect;
    own.color = reflectance(out.textures(), m.specular_reflectance, at.uv) * here.covered;
    own.fresnel = FresnelKind::dielectric;
    own.distribution = m.distribution;
    own.alpha_u = here.alpha_u, own.alpha_v = here.alpha_v;
    own.eta = m.eta;
    if (m.eta != 1) out.push(own, point, weight);
  }

  Rgb albedo(0), returned(0);
  for (int k = 0; k < nested.count; ++k) {
    Lobe lobe = nested.lobes[k];
    if (lobe.coat) throw InternalError("a coating over a coating");
    // From behind there is no layer before what is reflected there.
    if (!out.front(at) && !transmits(lobe.kind)) {
      out.push(lobe, point, weight);
      continue;
    }
    widen(layer, lobe);
    if (!transmits(lobe.kind)) lobe.color *= layer.scale;
    const UnderCoat nested_lobe = under_coat(view_from(lobe, true));
    Base base = base_of(layer, nested_lobe);
    if (lobe.sheen_layer) {
      const float left = sheen_layer_factor(lobe.sheen_layer, 2.0f / 3);
      base.albedo *= left, base.returned *= left, base.trapped *= left;
    }
    albedo += base.albedo, returned += base.returned;
    if (lobe.kind == LobeKind::diffuse && !lobe.sheen_layer) {
      out.push(diffuse_under(layer, lobe.color), point, weight);
      continue;
    }
    out.push(lobe_under(layer, nested_lobe, base, lobe), point, weight);
  }
  if (!out.front(at)) return;
  Rgb again(0);
  for (int c = 0; c < 3; ++c) {
    const float a = std::min(albedo[c], 1.0f);
    again[c] = a * returned[c] / (1 - a * layer.diffuse_return[c]);
  }
  out.push(diffuse_under(layer, again), point, weight);
}

}  // namespace lumirank::scatter
