// Coats and cloth: KHR_materials_clearcoat and KHR_materials_sheen.
#include "scenedesc/gltf/surface.h"

namespace lumirank::scenedesc::gltf {

int Reader::sheen_bsdf(const Element& material, const Surface& s, const Element& sheen) {
  const ColorInput color = color_input(sheen, "sheenColorFactor", Rgb(0), "sheenColorTexture");
  if (color.texture == kNone && color.value == Rgb(0)) return opaque_bsdf(material, s);
  warn(sheen, "sheen with a colour and a roughness of its own", "white sheen as in the principled BSDF");
  PrincipledDesc cloth;
  cloth.base_color = s.base;
  cloth.roughness = s.roughness;
  cloth.metallic = s.metallic;
  cloth.eta = s.ior;
  cloth.sheen = color.texture == kNone ? FloatInput{std::min(max_component(color.value), 1.0f)}
                                       : FloatInput{0, color.texture};
  return add_bsdf(material, cloth);
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
  return add_bsdf(clearcoat, coat);
}

}  // namespace lumirank::scenedesc::gltf
