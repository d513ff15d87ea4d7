// Coats, cloth and brushed surfaces: KHR_materials_clearcoat, KHR_materials_sheen, KHR_materials_anisotropy.
#include "scenedesc/gltf/surface.h"

namespace lumirank::scenedesc::gltf {

int Reader::sheen_bsdf(const Element& material, const Surface& s, const Element& sheen) {
  ColorInput color = color_input(sheen, "sheenColorFactor", Rgb(0), "sheenColorTexture");
  if (color.texture == kNone && color.value == Rgb(0)) return opaque_bsdf(material, s);
  if (color.texture == kNone && max_component(color.value) > 1) {
    warn(sheen.at("sheenColorFactor"), "a sheen color above 1", "1");
    color.value = clamp_below(color.value, 1.0f);
  }
  SheenDesc cloth;
  cloth.color = color;
  cloth.roughness =
      float_input(sheen, "sheenRoughnessFactor", 0, "sheenRoughnessTexture", TextureChannel::alpha);
  // The model has no limit at 0, which is the extension's default.
  constexpr float min_roughness = 0.07f;
  if (cloth.roughness.texture == kNone && cloth.roughness.value < min_roughness) {
    warn(sheen, "sheen of a roughness below 0.07", "0.07");
    cloth.roughness.value = min_roughness;
  }
  cloth.nested = opaque_bsdf(material, s);
  return add_bsdf(sheen, cloth);
}

// KHR_materials_diffuse_transmission: a share of what enters leaves on the other side.
int Reader::leaf_bsdf(const Element& material, const Surface& s, const Element& transmission) {
  const FloatInput share = float_input(transmission, "diffuseTransmissionFactor", 0,
                                       "diffuseTransmissionTexture", TextureChannel::alpha);
  DiffuseTransmitterDesc leaf;
  leaf.transmittance =
      color_input(transmission, "diffuseTransmissionColorFactor", Rgb(1), "diffuseTransmissionColorTexture");
  if (leaf.transmittance.texture == kNone)
    leaf.transmittance.value = clamp_below(leaf.transmittance.value, 1.0f);
  if (volume_of(material)) warn(material, "a solid that lets light through diffusely", "a thin sheet");
  const int opaque = two_sided(material, opaque_bsdf(material, s));
  return mix(material, s.metallic, opaque, mix(material, share, add_bsdf(transmission, leaf), opaque));
}

int Reader::turned_bsdf(const Element& anisotropy, int base) {
  TurnedTangentDesc turned;
  turned.angle = anisotropy.real("anisotropyRotation", 0);
  turned.nested = base;
  if (const auto info = anisotropy.find("anisotropyTexture"))
    if (const int texture = build_texture(*info, true, TextureChannel::rgb); texture != kNone)
      turned.direction = {Rgb(0), texture};
  if (turned.direction.texture == kNone && turned.angle == 0) return base;
  return add_bsdf(anisotropy, turned);
}

int Reader::coated_bsdf(const Element& clearcoat, int base) {
  const FloatInput share =
      float_input(clearcoat, "clearcoatFactor", 0, "clearcoatTexture", TextureChannel::red);
  if (share.texture == kNone && share.value == 0) return base;
  const FloatInput roughness = float_input(clearcoat, "clearcoatRoughnessFactor", 0,
                                           "clearcoatRoughnessTexture", TextureChannel::green);
  if (clearcoat.has("clearcoatNormalTexture"))
    warn(clearcoat, "a normal map of the clear coat", "the normal map of what is below");
  CoatingDesc coat;
  coat.nested = base;
  coat.eta = 1.5f;
  coat.distribution = Distribution::ggx;
  coat.alpha_u = coat.alpha_v = squared(clearcoat, roughness);
  coat.weight = share;
  coat.straight = true;
  return add_bsdf(clearcoat, coat);
}

}  // namespace lumirank::scenedesc::gltf
