#include "scatter/closure_builder.h"

#include <utility>

#include "base/error.h"
#include "scatter/interface.h"
#include "scatter/lobe.h"
#include "scatter/lobes/family.h"
#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

// Whether the lobe's index is read from wo's side, so that turning the frame inverts it.
bool index_has_a_side(const Lobe& lobe) {
  const LobeFamily& family = family_of(lobe.kind);
  if (family.fresnel) return lobe.fresnel == FresnelKind::dielectric && lobe.variant == 0;
  return family.refracts;
}

}  // namespace

Lobe lobe_of(LobeKind kind, Rgb color) {
  Lobe lobe;
  lobe.kind = kind;
  lobe.color = color;
  return lobe;
}

void ClosureBuilder::add(int material, const SurfacePoint& at, float weight) {
  if (!(weight > 0)) return;
  if (material < 0 || static_cast<std::size_t>(material) >= set_.materials.size())
    throw InternalError("material index " + std::to_string(material) + " of " +
                        std::to_string(set_.materials.size()));
  std::visit([&](const auto& m) { add_lobes(m, *this, at, weight); },
             set_.materials[static_cast<std::size_t>(material)]);
}

Closure ClosureBuilder::finish(const SurfacePoint& at) {
  if (frame_weight_ == 0) out_.frame = at.shading, out_.ng = at.ng;
  // Turned frames are left-handed until here.
  out_.frame.t = cross(out_.frame.n, out_.frame.s);
  if (out_.is_fiber()) out_.ng = {};
  return out_;
}

void ClosureBuilder::use_frame(const SurfacePoint& at, float weight) {
  if (weight <= frame_weight_ || (frame_weight_ > 0 && dot(at.ng, out_.ng) < 0)) return;
  frame_weight_ = weight;
  out_.frame = at.shading;
  out_.ng = at.ng;
}

void ClosureBuilder::push(Lobe lobe, const SurfacePoint& at, float weight) {
  if (lobe.kind != LobeKind::delta_pass || lobe.variant != 0) use_frame(at, weight);
  lobe.color *= weight;
  if (family_of(lobe.kind).two_colors) lobe.conductor_eta *= weight;
  if (index_has_a_side(lobe) && dot(at.ng, out_.ng) < 0) lobe.eta = 1 / lobe.eta;
  if (absorb(out_, lobe)) return;
  if (out_.count == kMaxLobes)
    merge_lobes(out_, lobe);
  else
    out_.add(lobe);
}

void add_lobes(const NullMaterial&, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  out.push(lobe_of(LobeKind::delta_pass, Rgb(1)), at, weight);
}

void add_lobes(const DiffuseMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  if (out.front(at))
    out.push(lobe_of(LobeKind::diffuse, reflectance(out.textures(), m.reflectance, at.uv)), at, weight);
}

void add_lobes(const RoughDiffuseMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  if (!out.front(at)) return;
  const Rgb rho = reflectance(out.textures(), m.reflectance, at.uv);
  Lobe lobe = lobe_of(LobeKind::oren_nayar, rho);
  lobe.conductor_eta = rho * rho;
  // The Gaussian slope width α of a Beckmann surface is √2 times the standard deviation of its slopes.
  lobe.alpha_u = lobe.alpha_v = std::max(0.0f, number(out.textures(), m.alpha, at.uv)) * 0.70710678f;
  out.push(lobe, at, weight);
}

void add_lobes(const ConductorMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  if (!out.front(at)) return;
  Lobe lobe = lobe_of(m.smooth ? LobeKind::delta_reflect : LobeKind::microfacet_reflect,
                      reflectance(out.textures(), m.specular_reflectance, at.uv));
  lobe.fresnel = FresnelKind::conductor;
  lobe.conductor_eta = m.eta, lobe.conductor_k = m.k;
  if (!m.smooth) {
    lobe.distribution = m.distribution;
    lobe.alpha_u = rough_alpha(out.textures(), m.alpha_u, at.uv);
    lobe.alpha_v = rough_alpha(out.textures(), m.alpha_v, at.uv);
  }
  out.push(lobe, at, weight);
}

void add_lobes(const DielectricMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  const Rgb reflected = reflectance(out.textures(), m.specular_reflectance, at.uv);
  const Rgb transmitted = reflectance(out.textures(), m.specular_transmittance, at.uv);
  Lobe lobe = lobe_of(m.smooth ? LobeKind::delta_reflect : LobeKind::microfacet_reflect, reflected);
  lobe.fresnel = FresnelKind::dielectric;
  lobe.eta = m.eta;
  if (!m.smooth) {
    // A rough interface between equal indices bends nothing, and the microfacet formula has no limit there.
    if (std::abs(m.eta - 1) < 1e-3f) return out.push(lobe_of(LobeKind::delta_pass, transmitted), at, weight);
    lobe.distribution = m.distribution;
    lobe.alpha_u = rough_alpha(out.textures(), m.alpha_u, at.uv);
    lobe.alpha_v = rough_alpha(out.textures(), m.alpha_v, at.uv);
  }
  out.push(lobe, at, weight);
  lobe.kind = m.smooth ? LobeKind::delta_transmit : LobeKind::microfacet_transmit;
  lobe.color = transmitted;
  out.push(lobe, at, weight);
}

namespace {

template <typename Sheet>
void add_sheet(const Sheet& m, std::uint8_t variant, ClosureBuilder& out, const SurfacePoint& at,
               float weight) {
  Lobe lobe = lobe_of(LobeKind::delta_reflect, reflectance(out.textures(), m.specular_reflectance, at.uv));
  lobe.fresnel = FresnelKind::dielectric;
  lobe.variant = variant;
  lobe.eta = m.eta;
  out.push(lobe, at, weight);
  lobe.kind = LobeKind::delta_pass;
  lobe.color = reflectance(out.textures(), m.specular_transmittance, at.uv);
  out.push(lobe, at, weight);
}

}  // namespace

void add_lobes(const ThinDielectricMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  add_sheet(m, kThinSlab, out, at, weight);
}
void add_lobes(const SlabFaceMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  add_sheet(m, kSlabFace, out, at, weight);
}

void add_lobes(const PlasticMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  if (!out.front(at)) return;
  const float alpha = m.smooth ? 0.0f : rough_alpha(out.textures(), m.alpha, at.uv);
  Lobe coat = lobe_of(m.smooth ? LobeKind::delta_reflect : LobeKind::microfacet_reflect,
                      reflectance(out.textures(), m.specular_reflectance, at.uv));
  coat.fresnel = FresnelKind::dielectric;
  coat.distribution = m.distribution;
  coat.alpha_v = alpha;
  coat.alpha_u = m.smooth ? alpha : stretched_alpha(alpha, fraction(out.textures(), m.stretch, at.uv));
  coat.eta = m.eta;
  const float mean_alpha = std::sqrt(coat.alpha_u * coat.alpha_v);
  Rgb base = reflectance(out.textures(), m.diffuse_reflectance, at.uv);
  if (m.schlick) {
    coat.fresnel = FresnelKind::schlick;
    coat.conductor_eta = std::exchange(coat.color, Rgb(1));
    if (!m.smooth)
      out.push(masked_reflection_lobe(coat.conductor_eta, m.distribution, mean_alpha), at, weight);
    // The base is made for an interface of index eta, which leaves 1 - its own reflectance.
    const float own = square((m.eta - 1) / (m.eta + 1));
    base *= std::min(1.0f, (1 - max_component(coat.conductor_eta)) / (1 - own));
  }
  out.push(coat, at, weight);
  out.push(m.lossless ? lossless_diffuse_lobe(base, m.eta, m.distribution, mean_alpha)
                      : interfaced_diffuse_lobe(base, m.eta, m.distribution, mean_alpha, m.nonlinear,
                                                m.as_mitsuba_3),
           at, weight);
}

namespace {

// Diffuse and specular reflectance that together exceed 1 in some channel are scaled down alike, as Mitsuba
// 0.6 does.
void conserve(Rgb& diffuse, Rgb& specular) {
  const float max_reflectance = max_component(diffuse + specular);
  if (max_reflectance > 1) diffuse *= 1 / max_reflectance, specular *= 1 / max_reflectance;
}

}  // namespace

void add_lobes(const PhongMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  if (!out.front(at)) return;
  Rgb diffuse = reflectance(out.textures(), m.diffuse_reflectance, at.uv);
  Rgb specular = reflectance(out.textures(), m.specular_reflectance, at.uv);
  conserve(diffuse, specular);
  out.push(lobe_of(LobeKind::diffuse, diffuse), at, weight);
  Lobe lobe = lobe_of(LobeKind::phong, specular);
  lobe.alpha_u = std::clamp(number(out.textures(), m.exponent, at.uv), 0.0f, 1e6f);
  out.push(lobe, at, weight);
}

void add_lobes(const WardMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  if (!out.front(at)) return;
  Rgb diffuse = reflectance(out.textures(), m.diffuse_reflectance, at.uv);
  Rgb specular = reflectance(out.textures(), m.specular_reflectance, at.uv);
  conserve(diffuse, specular);
  out.push(lobe_of(LobeKind::diffuse, diffuse), at, weight);
  Lobe lobe = lobe_of(LobeKind::ward, specular);
  lobe.variant = static_cast<std::uint8_t>(m.variant);
  lobe.alpha_u = rough_alpha(out.textures(), m.alpha_u, at.uv);
  lobe.alpha_v = rough_alpha(out.textures(), m.alpha_v, at.uv);
  out.push(lobe, at, weight);
}

void add_lobes(const DiffuseTransmitterMaterial& m, ClosureBuilder& out, const SurfacePoint& at,
               float weight) {
  Rgb reflected = reflectance(out.textures(), m.reflectance, at.uv);
  Rgb transmitted = reflectance(out.textures(), m.transmittance, at.uv);
  conserve(reflected, transmitted);
  out.push(lobe_of(LobeKind::diffuse, reflected), at, weight);
  out.push(lobe_of(LobeKind::diffuse_transmit, transmitted), at, weight);
}

void add_lobes(const HairMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  Rgb diffuse = reflectance(out.textures(), m.diffuse_reflectance, at.uv);
  Rgb specular = reflectance(out.textures(), m.specular_reflectance, at.uv);
  conserve(diffuse, specular);
  out.push(lobe_of(LobeKind::hair_diffuse, diffuse), at, weight);
  Lobe lobe = lobe_of(LobeKind::hair_specular, specular);
  lobe.alpha_u = std::clamp(number(out.textures(), m.exponent, at.uv), 0.0f, 1e5f);
  lobe.alpha_v = hair_specular_scale(lobe.alpha_u);
  out.push(lobe, at, weight);
}

void add_lobes(const MaskMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  const float opacity = fraction(out.textures(), m.opacity, at.uv);
  out.add(m.nested, at, weight * opacity);
  if (opacity < 1) out.push(lobe_of(LobeKind::delta_pass, Rgb(1)), at, weight * (1 - opacity));
}

void add_lobes(const TwoSidedMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  if (out.front(at))
    out.add(m.front, at, weight);
  else
    out.add(m.back, turned(at), weight);
}

void add_lobes(const BumpMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  out.add(m.nested, bumped(out.textures(), m, at), weight);
}

void add_lobes(const NormalMapMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  out.add(m.nested, normal_mapped(out.textures(), m, at), weight);
}

void add_lobes(const TurnedTangentMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  out.add(m.nested, with_turned_tangent(out.textures(), m, at), weight);
}

void add_lobes(const MixtureMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  const std::vector<float> weights = mixture_weights(out.textures(), m, at.uv);
  for (std::size_t k = 0; k < weights.size(); ++k) out.add(m.parts[k].nested, at, weight * weights[k]);
}

}  // namespace lumirank::scatter
