// Whether and how much light passes straight through a material.
#include "scatter/closure_builder.h"
#include "scatter/fresnel.h"

namespace lumirank::scatter {
namespace {

using Passage = MaterialSet::Passage;

struct PassageVisitor {
  const MaterialSet& set;

  template <typename Leaf>
  Passage operator()(const Leaf&) const {
    return Passage::opaque;
  }
  Passage operator()(const NullMaterial&) const { return Passage::attenuating; }
  Passage operator()(const ThinDielectricMaterial&) const { return Passage::attenuating; }
  Passage operator()(const SlabFaceMaterial&) const { return Passage::attenuating; }
  Passage operator()(const CoatingMaterial& m) const {
    // What a layer takes from the light in a cut-out's holes is no binary matter.
    return set.passage(m.nested) == Passage::opaque ? Passage::opaque : Passage::attenuating;
  }
  Passage operator()(const MaskMaterial& m) const {
    const Passage inside = set.passage(m.nested);
    if (inside != Passage::opaque) return inside;
    return m.opacity.texture < 0 && m.opacity.value >= 1 ? Passage::opaque : Passage::cutout;
  }
  Passage operator()(const TwoSidedMaterial& m) const {
    const Passage front = set.passage(m.front);
    // Two different sides: what passes depends on the side, which a cut-out's binary test does not know.
    return m.front == m.back || (front == Passage::opaque && set.passage(m.back) == Passage::opaque)
               ? front
               : Passage::attenuating;
  }
  Passage operator()(const BumpMaterial& m) const { return set.passage(m.nested); }
  Passage operator()(const NormalMapMaterial& m) const { return set.passage(m.nested); }
  Passage operator()(const TurnedTangentMaterial& m) const { return set.passage(m.nested); }
  Passage operator()(const MixtureMaterial& m) const {
    for (const MixtureMaterial::Part& part : m.parts)
      if (set.passage(part.nested) != Passage::opaque) return Passage::attenuating;
    return Passage::opaque;
  }
};

struct TransmittanceVisitor {
  const MaterialSet& set;
  const SurfacePoint& at;
  Vec3f w;

  template <typename Leaf>
  Rgb operator()(const Leaf&) const {
    return Rgb(0);
  }
  Rgb operator()(const NullMaterial&) const { return Rgb(1); }
  Rgb operator()(const ThinDielectricMaterial& m) const { return through_sheet(m, true); }
  Rgb operator()(const SlabFaceMaterial& m) const { return through_sheet(m, false); }
  template <typename Sheet>
  Rgb through_sheet(const Sheet& m, bool whole) const {
    const float r = sheet_reflectance(whole, fresnel_dielectric(std::abs(dot(w, at.shading.n)), m.eta));
    return reflectance(set.textures, m.specular_transmittance, at.uv) * (1 - r);
  }
  Rgb operator()(const CoatingMaterial& m) const {
    const Rgb through = set.transmittance(m.nested, at, w);
    return is_black(through) ? through : through * coating_passage(set.textures, m, at, w);
  }
  Rgb operator()(const MaskMaterial& m) const {
    const float opacity = fraction(set.textures, m.opacity, at.uv);
    return Rgb(1 - opacity) + set.transmittance(m.nested, at, w) * opacity;
  }
  Rgb operator()(const TwoSidedMaterial& m) const {
    return set.transmittance(dot(w, at.ng) > 0 ? m.front : m.back, at, w);
  }
  Rgb operator()(const BumpMaterial& m) const {
    return set.transmittance(m.nested, bumped(set.textures, m, at), w);
  }
  Rgb operator()(const NormalMapMaterial& m) const {
    return set.transmittance(m.nested, normal_mapped(set.textures, m, at), w);
  }
  Rgb operator()(const TurnedTangentMaterial& m) const { return set.transmittance(m.nested, at, w); }
  Rgb operator()(const MixtureMaterial& m) const {
    const std::vector<float> weights = mixture_weights(set.textures, m, at.uv);
    Rgb sum(0);
    for (std::size_t k = 0; k < weights.size(); ++k)
      sum += set.transmittance(m.parts[k].nested, at, w) * weights[k];
    return sum;
  }
};

struct OpacityVisitor {
  const MaterialSet& set;
  const SurfaceUv& uv;

  template <typename Leaf>
  float operator()(const Leaf&) const {
    return 1;
  }
  float operator()(const MaskMaterial& m) const {
    return fraction(set.textures, m.opacity, uv) * set.opacity(m.nested, uv);
  }
  float operator()(const TwoSidedMaterial& m) const { return set.opacity(m.front, uv); }
  float operator()(const BumpMaterial& m) const { return set.opacity(m.nested, uv); }
  float operator()(const NormalMapMaterial& m) const { return set.opacity(m.nested, uv); }
  float operator()(const TurnedTangentMaterial& m) const { return set.opacity(m.nested, uv); }
};

struct HairVisitor {
  const MaterialSet& set;

  template <typename Leaf>
  bool operator()(const Leaf&) const {
    return false;
  }
  bool operator()(const HairMaterial&) const { return true; }
  bool operator()(const HairFiberMaterial&) const { return true; }
  bool operator()(const MaskMaterial& m) const { return set.is_hair(m.nested); }
  bool operator()(const MixtureMaterial& m) const {
    for (const MixtureMaterial::Part& part : m.parts)
      if (set.is_hair(part.nested)) return true;
    return false;
  }
};

}  // namespace

bool MaterialSet::is_hair(int material) const {
  return std::visit(HairVisitor{*this}, materials[static_cast<std::size_t>(material)]);
}

MaterialSet::Passage MaterialSet::passage(int material) const {
  return std::visit(PassageVisitor{*this}, materials[static_cast<std::size_t>(material)]);
}

Rgb MaterialSet::transmittance(int material, const SurfacePoint& at, Vec3f w) const {
  return std::visit(TransmittanceVisitor{*this, at, w}, materials[static_cast<std::size_t>(material)]);
}

float MaterialSet::opacity(int material, const SurfaceUv& uv) const {
  if (passage(material) != Passage::cutout) return 1;
  return std::visit(OpacityVisitor{*this, uv}, materials[static_cast<std::size_t>(material)]);
}

}  // namespace lumirank::scatter
