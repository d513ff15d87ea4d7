// Metallic-roughness materials and their extensions as sums of BSDFs.
//
// glTF 2.0, appendix B: a metal is GGX with Schlick's Fresnel factor from the base color: "principled" with
// metallic 1 is that formula. A dielectric is a GGX reflection of index 1.5 over a diffuse base: "plastic",
// lossless, whose base gets what is not reflected, so that nothing is lost or made; the appendix's own base ·
// (1 - F(half vector)) sends back more than it receives at grazing angles.
#include <cmath>

#include "base/vec.h"
#include "scenedesc/gltf/surface.h"

namespace lumirank::scenedesc::gltf {
namespace {

bool is_constant(const FloatInput& input, float value) {
  return input.texture == kNone && input.value == value;
}
// Sheets of a roughness up to this are clear: shadow rays pass them.
constexpr float kSmoothSheet = 0.1f;
constexpr float kLeastAlpha = 1e-3f;     // where it is stretched
constexpr float kMaxReflectance = 0.9f;  // at normal incidence, of what is not metal
bool is_black(const ColorInput& input) { return input.texture == kNone && input.value == Rgb(0); }

}  // namespace

struct Reader::BaseColor {
  Element at;
  std::string factor, texture;
};

int Reader::add_bsdf(const Element& at, decltype(BsdfDesc::kind) kind) {
  return SceneReader::add_bsdf(at.text("name", at.path()), at.where(), std::move(kind));
}

int Reader::mix(const Element& at, FloatInput weight, int one, int other) {
  if (is_constant(weight, 1) || one == other) return one;
  if (is_constant(weight, 0)) return other;
  MixtureDesc mixture;
  mixture.parts = {{weight, false, one}, {weight, true, other}};
  return add_bsdf(at, std::move(mixture));
}

int Reader::opaque_bsdf(const Element& material, const Surface& s) {
  if (s.specular) {
    PlasticDesc desc;
    desc.eta = 1.5f;
    desc.diffuse_reflectance = s.base;
    desc.specular_reflectance = *s.specular;
    desc.distribution = Distribution::ggx;
    desc.alpha = s.alpha;
    desc.lossless = desc.schlick = true;
    return add_bsdf(material, desc);
  }
  int metal = kNone, dielectric = kNone;
  if (!is_constant(s.metallic, 0)) {
    PrincipledDesc principled;
    principled.base_color = s.base;
    principled.roughness = s.roughness;
    principled.metallic = {1};
    principled.lossless = true;
    principled.stretch = s.stretch;
    metal = add_bsdf(material, principled);
  }
  if (!is_constant(s.metallic, 1)) {
    FloatInput weight{1};
    ColorInput tint{Rgb(1)};
    float eta = s.ior;
    if (const auto specular = material.extension("KHR_materials_specular")) {
      weight = float_input(*specular, "specularFactor", 1, "specularTexture", TextureChannel::alpha);
      tint = color_input(*specular, "specularColorFactor", Rgb(1), "specularColorTexture");
      const float max_tint = max_component(tint.value);
      if (tint.texture == kNone && max_tint > 1 && s.ior != 1) {
        // More than the index of refraction reflects at normal incidence: so has a larger one, tinted.
        const float usual = square((s.ior - 1) / (s.ior + 1));
        float reflectance = usual * max_tint;
        if (reflectance > kMaxReflectance) {
          warn(specular->at("specularColorFactor"), "a specular color that reflects more than 0.9", "0.9");
          reflectance = kMaxReflectance;
        }
        tint.value = (1 / reflectance) * clamp_below(usual * tint.value, reflectance);
        eta = (1 + std::sqrt(reflectance)) / (1 - std::sqrt(reflectance));
      }
    }
    if (s.ior == 1 || is_black(tint)) weight = {0};
    int plastic = kNone, diffuse = kNone;
    if (!is_constant(weight, 0)) {
      PlasticDesc desc;
      desc.eta = eta;
      desc.diffuse_reflectance = s.base;
      desc.specular_reflectance = tint;
      desc.distribution = Distribution::ggx;
      desc.alpha = s.alpha;
      desc.stretch = s.stretch;
      desc.lossless = true;
      plastic = add_bsdf(material, desc);
    }
    if (!is_constant(weight, 1)) diffuse = add_bsdf(material, DiffuseDesc{s.base});
    dielectric = mix(material, weight, plastic, diffuse);
  }
  return mix(material, s.metallic, metal, dielectric);
}

int Reader::two_sided(const Element& at, int bsdf) { return add_bsdf(at, TwoSidedDesc{bsdf, bsdf}); }

int Reader::transmitting_bsdf(const Element& material, const Surface& s, const Element& transmission) {
  const FloatInput share =
      float_input(transmission, "transmissionFactor", 0, "transmissionTexture", TextureChannel::red);
  const bool opaque_part = !is_constant(share, 1) || !is_constant(s.metallic, 0);
  const int opaque = opaque_part ? two_sided(material, opaque_bsdf(material, s)) : kNone;
  int clear = kNone;
  if (volume_of(material)) {
    DielectricDesc glass;
    glass.eta = s.ior;
    glass.specular_transmittance = s.base;
    glass.distribution = Distribution::ggx;
    glass.alpha_u = glass.alpha_v = s.alpha;
    clear = add_bsdf(material, glass);
  } else {
    const bool smooth = s.roughness.texture == kNone && s.roughness.value <= kSmoothSheet;
    if (smooth || s.ior == 1) {
      clear = add_bsdf(material, ThinDielectricDesc{s.ior, {Rgb(1)}, s.base});
    } else {
      PrincipledThinDesc frosted;
      frosted.base_color = s.base;
      frosted.roughness = s.roughness;
      frosted.spec_trans = {1};
      frosted.eta = s.ior;
      clear = add_bsdf(material, frosted);
    }
  }
  if (!opaque_part) return clear;
  // share · (1 - metallic) of the light is transmitted.
  return mix(material, s.metallic, opaque, mix(material, share, clear, opaque));
}

// The uv set that the material's textures read. A mesh carries one.
int Reader::uv_set_of(const Element& material) {
  int found = -1;
  const auto visit = [&](const Element& object, const char* key) {
    const auto info = object.find(key);
    if (!info) return;
    auto set = info->find("texCoord");
    if (const auto transform = info->extension("KHR_texture_transform"))
      if (const auto other = transform->find("texCoord")) set = other;
    const int wanted = set ? static_cast<int>(set->integer(0, 99)) : 0;
    if (found < 0) found = wanted;
    if (wanted != found)
      warn(*info, "textures of one material on different uv sets", "set " + std::to_string(found));
  };
  if (const auto pbr = material.find("pbrMetallicRoughness")) {
    visit(*pbr, "baseColorTexture");
    visit(*pbr, "metallicRoughnessTexture");
  }
  visit(material, "normalTexture");
  visit(material, "emissiveTexture");
  const std::pair<const char*, const char*> others[] = {
      {"KHR_materials_pbrSpecularGlossiness", "diffuseTexture"},
      {"KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture"},
      {"KHR_materials_diffuse_transmission", "diffuseTransmissionTexture"},
      {"KHR_materials_diffuse_transmission", "diffuseTransmissionColorTexture"},
      {"KHR_materials_transmission", "transmissionTexture"},
      {"KHR_materials_specular", "specularTexture"},
      {"KHR_materials_specular", "specularColorTexture"},
      {"KHR_materials_sheen", "sheenColorTexture"},
      {"KHR_materials_sheen", "sheenRoughnessTexture"},
      {"KHR_materials_anisotropy", "anisotropyTexture"},
      {"KHR_materials_clearcoat", "clearcoatTexture"},
      {"KHR_materials_clearcoat", "clearcoatRoughnessTexture"}};
  for (const auto& [extension, texture] : others)
    if (const auto object = material.extension(extension)) visit(*object, texture);
  return std::max(found, 0);
}

void Reader::read_roughness(const Element& material, const BaseColor& base, Surface& s) {
  if (const auto glossy = material.extension("KHR_materials_pbrSpecularGlossiness")) {
    s.specular = color_input(*glossy, "specularFactor", Rgb(1), "specularGlossinessTexture");
    s.roughness = complement(*glossy, float_input(*glossy, "glossinessFactor", 1, "specularGlossinessTexture",
                                                  TextureChannel::alpha));
    s.metallic = {0};
  } else {
    s.metallic = float_input(base.at, "metallicFactor", 1, "metallicRoughnessTexture", TextureChannel::blue);
    s.roughness =
        float_input(base.at, "roughnessFactor", 1, "metallicRoughnessTexture", TextureChannel::green);
  }
  s.alpha = squared(material, s.roughness);
  const auto anisotropy = material.extension("KHR_materials_anisotropy");
  if (!anisotropy) return;
  s.stretch = float_input(*anisotropy, "anisotropyStrength", 0, "anisotropyTexture", TextureChannel::blue);
  // A mirror along one direction alone is no mirror.
  if (!is_constant(s.stretch, 0) && s.alpha.texture == kNone)
    s.alpha.value = std::max(s.alpha.value, kLeastAlpha);
}

Reader::Surface Reader::surface_of(const Element& material, const BaseColor& base, bool colored) {
  Surface s;
  s.base = color_input(base.at, base.factor, Rgb(1), base.texture);
  if (colored) {
    const ColorInput vertex{Rgb(0), add_texture(material, VertexColorTextureDesc{"COLOR_0"})};
    s.base = {Rgb(0), s.base.texture == kNone && s.base.value == Rgb(1) ? vertex.texture
                                                                        : product(material, s.base, vertex)};
  }
  read_roughness(material, base, s);
  if (const auto ior = material.extension("KHR_materials_ior")) {
    s.ior = ior->real("ior", 1.5f, 0, 100);
    if (s.ior == 0) {
      warn(*ior, "an index of refraction of 0 (a mirror of any color)", "1.5");
      s.ior = 1.5f;
    } else if (s.ior < 1) {
      ior->at("ior").fail("is less than 1", "give 1 or more, or 0");
    }
  }
  return s;
}

// The surface with its layers and sides, as one that light falls on.
int Reader::lit_bsdf(const Element& material, const Surface& s) {
  const auto transmission = material.extension("KHR_materials_transmission");
  const auto sheen = material.extension("KHR_materials_sheen");
  const bool transmits = transmission && transmission->real("transmissionFactor", 0, 0, 1) > 0;
  if (transmits && sheen) warn(material, "sheen on a surface that transmits light", "");
  const auto leaf = material.extension("KHR_materials_diffuse_transmission");
  const bool shines_through = !transmits && leaf && leaf->real("diffuseTransmissionFactor", 0, 0, 1) > 0;
  if (shines_through && sheen) warn(material, "sheen on a surface that transmits light", "");
  int bsdf = transmits        ? transmitting_bsdf(material, s, *transmission)
             : shines_through ? leaf_bsdf(material, s, *leaf)
             : sheen          ? sheen_bsdf(material, s, *sheen)
                              : opaque_bsdf(material, s);
  if (const auto clearcoat = material.extension("KHR_materials_clearcoat"))
    bsdf = coated_bsdf(*clearcoat, bsdf);
  if (!transmits && !shines_through) bsdf = two_sided(material, bsdf);
  if (!is_constant(s.stretch, 0)) {
    const Element anisotropy = *material.extension("KHR_materials_anisotropy");
    if (transmits)
      warn(anisotropy, "anisotropy of what lets light pass", "refraction alike in all directions");
    bsdf = turned_bsdf(anisotropy, bsdf);
  }
  return normal_mapped(material, bsdf);
}

std::optional<ColorInput> Reader::emission_of(const Element& material) {
  const float strength = [&] {
    const auto extension = material.extension("KHR_materials_emissive_strength");
    return extension ? extension->real("emissiveStrength", 1, 0) : 1.0f;
  }();
  ColorInput emission = color_input(material, "emissiveFactor", Rgb(0), "emissiveTexture");
  if (emission.texture != kNone)
    emission.texture = scaled(material, emission.texture, Rgb(strength));
  else
    emission.value *= strength;
  if (is_black(emission) || !(strength > 0)) return std::nullopt;
  return emission;
}

Reader::BuiltMaterial Reader::make_material(const Element& material, bool colored) {
  BuiltMaterial out;
  out.uv_set = uv_set_of(material);
  out.name = material.text("name", material.path());
  const Json nothing{Json::Kind::object, false, material.where().line, 0, {}, {}, {}};
  const auto given = material.find("pbrMetallicRoughness");
  BaseColor base{given ? *given : Element(nothing, material.path(), material.file()), "baseColorFactor",
                 "baseColorTexture"};
  if (const auto glossy = material.extension("KHR_materials_pbrSpecularGlossiness"))
    base = {*glossy, "diffuseFactor", "diffuseTexture"};

  const Surface s = surface_of(material, base, colored);
  if (material.extension("KHR_materials_unlit")) {
    warn(material, "an unlit material", "a black surface that shines in its base color");
    out.bsdf = add_bsdf(material, DiffuseDesc{{Rgb(0)}});
    out.emission = s.base;
  } else {
    out.bsdf = lit_bsdf(material, s);
    out.medium = medium_of(material);
    out.emission = emission_of(material);
    if (material.has("occlusionTexture"))
      note(material, "baked occlusion, which light transport makes by itself, is left out");
  }
  out.bsdf = cut_out(material, base, out.bsdf);
  if (out.emission && material.flag("doubleSided", false)) {
    // A back of its own would halve what shows through.
    out.emits_both_ways = material.text("alphaMode", "OPAQUE") != "BLEND";
    if (!out.emits_both_ways)
      warn(material, "emission from the back of a blended double-sided material", "emission from its front");
  }
  if (given && !material.flag("doubleSided", false))
    note(material, "back faces of single-sided materials are shown as well");
  return out;
}

int Reader::normal_mapped(const Element& material, int base) {
  const auto info = material.find("normalTexture");
  if (!info) return base;
  NormalMapDesc map;
  map.texture = build_texture(*info, true, TextureChannel::rgb);
  map.nested = base;
  map.scale = info->real("scale", 1);
  map.follow_uv = true;
  return map.texture == kNone ? base : add_bsdf(material, map);
}

int Reader::cut_out(const Element& material, const BaseColor& color, int base) {
  const std::string mode = material.text("alphaMode", "OPAQUE");
  if (mode == "OPAQUE") return base;
  if (mode != "MASK" && mode != "BLEND")
    material.at("alphaMode").fail("is \"" + mode + "\"", "OPAQUE, MASK and BLEND are known");
  FloatInput opacity{1};
  if (const auto factor = color.at.find(color.factor); factor && factor->size() == 4) {
    const Element alpha = factor->item(3);
    opacity.value = alpha.real();
    if (opacity.value < 0 || opacity.value > 1) alpha.fail("is an alpha outside [0, 1]", "give a share");
  }
  if (const auto info = color.at.find(color.texture)) {
    const int texture = build_texture(*info, true, TextureChannel::alpha);
    if (texture != kNone && !without_alpha(texture))
      opacity = {0, scaled(*info, texture, Rgb(opacity.value))};
  }
  if (mode == "MASK") {
    const float cutoff = material.real("alphaCutoff", 0.5f, 0);
    if (opacity.texture != kNone)
      opacity.texture = add_texture(material, ThresholdTextureDesc{{Rgb(0), opacity.texture}, cutoff});
    else
      opacity.value = opacity.value >= cutoff ? 1.0f : 0.0f;
  }
  return is_constant(opacity, 1) ? base : add_bsdf(material, MaskDesc{opacity, base});
}

const Reader::BuiltMaterial& Reader::build_material(int material, bool colored) {
  const auto [found, fresh] = built_materials_.try_emplace({material, colored});
  if (!fresh) return found->second;
  const Json nothing{Json::Kind::object, false, 0, 0, {}, {}, {}};
  found->second =
      make_material(material == kNone ? Element(nothing, "the default material", scene_.source_file)
                                      : materials_[static_cast<std::size_t>(material)],
                    colored);
  return found->second;
}

}  // namespace lumirank::scenedesc::gltf
